//! Built-in functions (§8.1 to §8.6) of constants: computed in f64, rounded once to f32.

use super::operators::{as_float, componentwise};
use super::{Held, Operand, Scalars};
use crate::builtin::BuiltinFunction as F;
use crate::hir::{ScalarValue, Type, TypeId, Types};
use ScalarValue::{Bool, Float, Int, Uint};

/// The value of a call with constant arguments; `None` for functions that are never constant.
pub(super) fn call(types: &Types, function: F, ty: TypeId, operands: &[Operand<'_>]) -> Option<Scalars> {
    let arguments = Arguments { types, operands };
    match function {
        F::Radians => arguments.map(f64::to_radians),
        F::Degrees => arguments.map(f64::to_degrees),
        F::Sin => arguments.map(f64::sin),
        F::Cos => arguments.map(f64::cos),
        F::Tan => arguments.map(f64::tan),
        F::Asin => arguments.map(f64::asin),
        F::Acos => arguments.map(f64::acos),
        F::Atan if operands.len() == 2 => arguments.map2(f64::atan2),
        F::Atan => arguments.map(f64::atan),
        F::Sinh => arguments.map(f64::sinh),
        F::Cosh => arguments.map(f64::cosh),
        F::Tanh => arguments.map(f64::tanh),
        F::Asinh => arguments.map(f64::asinh),
        F::Acosh => arguments.map(f64::acosh),
        F::Atanh => arguments.map(f64::atanh),
        F::Pow => arguments.map2(f64::powf),
        F::Exp => arguments.map(f64::exp),
        F::Log => arguments.map(f64::ln),
        F::Exp2 => arguments.map(f64::exp2),
        F::Log2 => arguments.map(f64::log2),
        F::Sqrt => arguments.map(f64::sqrt),
        F::Inversesqrt => arguments.map(|x| 1.0 / x.sqrt()),
        F::Abs => arguments.each(abs),
        F::Sign => arguments.each(sign),
        F::Floor => arguments.map(f64::floor),
        F::Trunc => arguments.map(f64::trunc),
        F::Round | F::RoundEven => arguments.map(f64::round_ties_even),
        F::Ceil => arguments.map(f64::ceil),
        F::Fract => arguments.map(|x| x - x.floor()),
        F::Mod => arguments.map2(|x, y| x - y * (x / y).floor()),
        F::Min => arguments.pick(0, 1, |x, y| less(y, x)),
        F::Max => arguments.pick(0, 1, less),
        F::Clamp => arguments.clamp(),
        F::Mix => arguments.mix(),
        F::Step => arguments.map2(|edge, x| if x < edge { 0.0 } else { 1.0 }),
        F::Smoothstep => arguments.map3(smoothstep),
        F::Isnan => arguments.each(|x| Some(Bool(as_float(&x)?.is_nan()))),
        F::Isinf => arguments.each(|x| Some(Bool(as_float(&x)?.is_infinite()))),
        F::Length => float(norm(&arguments.vector(0)?)),
        F::Distance => float(norm(&difference(&arguments.vector(0)?, &arguments.vector(1)?))),
        F::Dot => float(dot(&arguments.vector(0)?, &arguments.vector(1)?)),
        F::Cross => floats(&cross(&arguments.vector(0)?, &arguments.vector(1)?)?),
        F::Normalize => {
            let x = arguments.vector(0)?;
            let length = norm(&x);
            floats(&x.iter().map(|component| component / length).collect::<Vec<_>>())
        }
        F::Faceforward => {
            let flip = dot(&arguments.vector(2)?, &arguments.vector(1)?) < 0.0;
            let sign = if flip { 1.0 } else { -1.0 };
            floats(&arguments.vector(0)?.iter().map(|n| sign * n).collect::<Vec<_>>())
        }
        F::Reflect => {
            let (incident, normal) = (arguments.vector(0)?, arguments.vector(1)?);
            let twice = 2.0 * dot(&normal, &incident);
            floats(&incident.iter().zip(&normal).map(|(i, n)| i - twice * n).collect::<Vec<_>>())
        }
        F::Refract => arguments.refract(),
        F::MatrixCompMult => arguments.map2(|x, y| x * y),
        F::OuterProduct => {
            let (column, row) = (arguments.vector(0)?, arguments.vector(1)?);
            floats(&row.iter().flat_map(|r| column.iter().map(move |c| c * r)).collect::<Vec<_>>())
        }
        F::Transpose => arguments.transpose(),
        F::Determinant => float(determinant(&arguments.square(0)?)),
        F::Inverse => floats(&inverse(&arguments.square(0)?)),
        F::LessThan => arguments.compare(less),
        F::LessThanEqual => arguments.compare(|x, y| Some(less(x, y)? || x == y)),
        F::GreaterThan => arguments.compare(|x, y| less(y, x)),
        F::GreaterThanEqual => arguments.compare(|x, y| Some(less(y, x)? || x == y)),
        F::Equal => arguments.compare(|x, y| Some(x == y)),
        F::NotEqual => arguments.compare(|x, y| Some(x != y)),
        F::Any => one(Bool(operands.first()?.scalars.contains(&Bool(true)))),
        F::All => one(Bool(!operands.first()?.scalars.contains(&Bool(false)))),
        F::Not => arguments.each(|x| if let Bool(x) = x { Some(Bool(!x)) } else { None }),
        F::DFdx | F::DFdy | F::Fwidth => Some(Scalars::from_elem(Float(0.0), types.flat_len(ty) as usize)),
        F::Modf
        | F::TextureSize
        | F::Texture
        | F::TextureProj
        | F::TextureLod
        | F::TextureOffset
        | F::TexelFetch
        | F::TexelFetchOffset
        | F::TextureProjOffset
        | F::TextureLodOffset
        | F::TextureProjLod
        | F::TextureProjLodOffset
        | F::TextureGrad
        | F::TextureGradOffset
        | F::TextureProjGrad
        | F::TextureProjGradOffset
        | F::Noise1
        | F::Noise2
        | F::Noise3
        | F::Noise4
        | F::EmitVertex
        | F::EndPrimitive => None,
    }
}

struct Arguments<'a> {
    types: &'a Types,
    operands: &'a [Operand<'a>],
}

impl Arguments<'_> {
    fn operand(&self, index: usize) -> Option<&Operand<'_>> {
        self.operands.get(index)
    }

    fn each(&self, f: impl Fn(ScalarValue) -> Option<ScalarValue>) -> Option<Scalars> {
        self.operand(0)?.scalars.iter().map(|&scalar| f(scalar)).collect()
    }

    fn map(&self, f: impl Fn(f64) -> f64) -> Option<Scalars> {
        self.each(|x| Some(Float(f(f64::from(as_float(&x)?)) as f32)))
    }

    fn map2(&self, f: impl Fn(f64, f64) -> f64) -> Option<Scalars> {
        componentwise(self.operand(0)?, self.operand(1)?, |x, y| {
            Some(Float(f(f64::from(as_float(&x)?), f64::from(as_float(&y)?)) as f32))
        })
    }

    /// Of three arguments, of which some may be scalars beside vectors.
    fn map3(&self, f: impl Fn(f64, f64, f64) -> f64) -> Option<Scalars> {
        let len = self.operands.iter().map(|operand| operand.scalars.len()).max()?;
        (0..len)
            .map(|index| {
                let value = f(self.component(0, index)?, self.component(1, index)?, self.component(2, index)?);
                Some(Float(value as f32))
            })
            .collect()
    }

    fn component(&self, operand: usize, index: usize) -> Option<f64> {
        let scalars = &self.operand(operand)?.scalars;
        let value = if scalars.len() == 1 { scalars.first()? } else { scalars.get(index)? };
        as_float(value).map(f64::from)
    }

    /// `y` where `second(x, y)` holds, else `x`.
    fn pick(&self, x: usize, y: usize, second: impl Fn(ScalarValue, ScalarValue) -> Option<bool>) -> Option<Scalars> {
        componentwise(self.operand(x)?, self.operand(y)?, |x, y| Some(if second(x, y)? { y } else { x }))
    }

    /// `min(max(x, minVal), maxVal)`
    fn clamp(&self) -> Option<Scalars> {
        let above = Operand { ty: self.operand(0)?.ty, scalars: Held::Own(self.pick(0, 1, less)?) };
        componentwise(&above, self.operand(2)?, |x, y| Some(if less(y, x)? { y } else { x }))
    }

    fn mix(&self) -> Option<Scalars> {
        let chooses = matches!(self.operand(2)?.scalars.first(), Some(Bool(_)));
        if !chooses {
            return self.map3(|x, y, a| x * (1.0 - a) + y * a);
        }
        let (x, y, a) = (self.operand(0)?, self.operand(1)?, self.operand(2)?);
        let pairs = x.scalars.iter().zip(&*y.scalars);
        Some(pairs.zip(&*a.scalars).map(|((x, y), a)| if *a == Bool(true) { *y } else { *x }).collect())
    }

    fn compare(&self, f: impl Fn(ScalarValue, ScalarValue) -> Option<bool>) -> Option<Scalars> {
        componentwise(self.operand(0)?, self.operand(1)?, |x, y| f(x, y).map(Bool))
    }

    fn vector(&self, index: usize) -> Option<Vec<f64>> {
        self.operand(index)?.scalars.iter().map(|value| as_float(value).map(f64::from)).collect()
    }

    fn refract(&self) -> Option<Scalars> {
        let (incident, normal, eta) = (self.vector(0)?, self.vector(1)?, *self.vector(2)?.first()?);
        let cosine = dot(&normal, &incident);
        let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
        if k < 0.0 {
            return floats(&vec![0.0; incident.len()]);
        }
        let along = eta * cosine + k.sqrt();
        floats(&incident.iter().zip(&normal).map(|(i, n)| eta * i - along * n).collect::<Vec<_>>())
    }

    fn transpose(&self) -> Option<Scalars> {
        let operand = self.operand(0)?;
        let Type::Matrix(columns, rows) = self.types.get(operand.ty) else { return None };
        (0..rows)
            .flat_map(|row| (0..columns).map(move |column| usize::from(column) * usize::from(rows) + usize::from(row)))
            .map(|place| operand.scalars.get(place).copied())
            .collect()
    }

    /// The columns of a square matrix.
    fn square(&self, index: usize) -> Option<Vec<Vec<f64>>> {
        let Type::Matrix(size, _) = self.types.get(self.operand(index)?.ty) else { return None };
        Some(self.vector(index)?.chunks(usize::from(size)).map(<[f64]>::to_vec).collect())
    }
}

fn one(value: ScalarValue) -> Option<Scalars> {
    Some(Scalars::from_slice(&[value]))
}

fn float(value: f64) -> Option<Scalars> {
    one(Float(value as f32))
}

fn floats(values: &[f64]) -> Option<Scalars> {
    Some(values.iter().map(|&value| Float(value as f32)).collect())
}

fn abs(value: ScalarValue) -> Option<ScalarValue> {
    match value {
        Int(x) => Some(Int(x.wrapping_abs())),
        Float(x) => Some(Float(x.abs())),
        Bool(_) | Uint(_) => None,
    }
}

fn sign(value: ScalarValue) -> Option<ScalarValue> {
    match value {
        Int(x) => Some(Int(x.signum())),
        Float(x) => Some(Float(f32::from(i8::from(x > 0.0) - i8::from(x < 0.0)))),
        Bool(_) | Uint(_) => None,
    }
}

fn less(x: ScalarValue, y: ScalarValue) -> Option<bool> {
    match (x, y) {
        (Int(x), Int(y)) => Some(x < y),
        (Uint(x), Uint(y)) => Some(x < y),
        (Float(x), Float(y)) => Some(x < y),
        _ => None,
    }
}

fn smoothstep(edge0: f64, edge1: f64, x: f64) -> f64 {
    let t = ((x - edge0) / (edge1 - edge0)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

fn difference(x: &[f64], y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x - y).collect()
}

fn cross(x: &[f64], y: &[f64]) -> Option<[f64; 3]> {
    let (&[x0, x1, x2], &[y0, y1, y2]) = (x, y) else { return None };
    Some([x1 * y2 - y1 * x2, x2 * y0 - y2 * x0, x0 * y1 - y0 * x1])
}

/// By cofactors of the first column; `columns` is square, 1 to 4 wide.
fn determinant(columns: &[Vec<f64>]) -> f64 {
    match columns {
        [] => 1.0,
        [first, ..] => {
            let terms = first.iter().enumerate().map(|(row, value)| {
                let sign = if row % 2 == 0 { 1.0 } else { -1.0 };
                sign * value * determinant(&minor(columns, 0, row))
            });
            terms.sum()
        }
    }
}

/// The matrix without one column and one row.
fn minor(columns: &[Vec<f64>], without_column: usize, without_row: usize) -> Vec<Vec<f64>> {
    let keep_column = |&(column, _): &(usize, &Vec<f64>)| column != without_column;
    let keep_rows = |(_, column): (usize, &Vec<f64>)| {
        column.iter().enumerate().filter(|&(row, _)| row != without_row).map(|(_, &value)| value).collect()
    };
    columns.iter().enumerate().filter(keep_column).map(keep_rows).collect()
}

/// The adjugate over the determinant, by columns.
fn inverse(columns: &[Vec<f64>]) -> Vec<f64> {
    let size = columns.len();
    let determinant_of_all = determinant(columns);
    let mut result = Vec::with_capacity(size * size);
    for column in 0..size {
        for row in 0..size {
            let sign = if (column + row) % 2 == 0 { 1.0 } else { -1.0 };
            result.push(sign * determinant(&minor(columns, row, column)) / determinant_of_all);
        }
    }
    result
}
