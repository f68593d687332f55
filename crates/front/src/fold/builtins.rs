//! Evaluates built-in functions (§8.1 to §8.6) of constants: computed in f64 by the kernels of the table of
//! operations, and rounded once to f32.
//!
//! *Holds:* a value equals the reference's f32 result bit for bit. A test of the reference runs both over all
//! functions and special values.

use super::operators::{as_float, componentwise};
use super::{Held, Operand, Scalars};
use crate::builtin::BuiltinFunction;
use crate::builtin::operations::{
    Binary, BitCast, BitFunction, BooleanFunction, Class, Composite, MatrixFunction, Numbers, Relation, Ternary, Test,
    Unary,
};
use crate::hir::{ScalarValue, Type, TypeId, Types};
use ScalarValue::{Bool, Float, Int, Uint};

/// The value of a call with constant arguments; `None` for functions that are never constant.
pub(super) fn call(types: &Types, function: BuiltinFunction, ty: TypeId, operands: &[Operand<'_>]) -> Option<Scalars> {
    let arguments = Arguments { types, operands };
    match function.class() {
        Class::Unary(op) => arguments.map(op),
        Class::Binary(op) => arguments.map2(op),
        Class::Ternary(op) => arguments.map3(op),
        Class::Numbers(op) => arguments.numbers(op),
        Class::Composite(op) => arguments.composite(op),
        Class::Matrix(MatrixFunction::ComponentProduct) => arguments.map2(Binary::Mul),
        Class::Matrix(MatrixFunction::OuterProduct) => {
            let (column, row) = (arguments.vector(0)?, arguments.vector(1)?);
            floats(&row.iter().flat_map(|r| column.iter().map(move |c| c * r)).collect::<Vec<_>>())
        }
        Class::Matrix(MatrixFunction::Transpose) => arguments.transpose(),
        Class::Relation(op) => arguments.relation(op),
        Class::Boolean(BooleanFunction::Any) => one(Bool(operands.first()?.scalars.contains(&Bool(true)))),
        Class::Boolean(BooleanFunction::All) => one(Bool(!operands.first()?.scalars.contains(&Bool(false)))),
        Class::Boolean(BooleanFunction::Not) => arguments.each(|x| if let Bool(x) = x { Some(Bool(!x)) } else { None }),
        Class::Test(Test::Nan) => arguments.each(|x| Some(Bool(as_float(&x)?.is_nan()))),
        Class::Test(Test::Infinite) => arguments.each(|x| Some(Bool(as_float(&x)?.is_infinite()))),
        // Zero in a constant expression (§4.3.3).
        Class::Derivative(_) => Some(Scalars::from_elem(Float(0.0), types.flat_len(ty) as usize)),
        Class::BitCast(op) => arguments.each(|x| bit_cast(op, x)),
        Class::Bits(op) => arguments.bits(op),
        Class::Packing(op) if op.unpacks => {
            let Uint(bits) = *operands.first()?.scalars.first()? else { return None };
            let part = |index: u32| bits.checked_shr(index * op.bits()).unwrap_or(0);
            Some((0..u32::from(op.components)).map(|index| Float(op.unpacked(part(index)) as f32)).collect())
        }
        Class::Packing(op) => {
            let parts = arguments.vector(0)?.into_iter().zip(0..);
            one(Uint(parts.fold(0, |all, (value, index)| all | op.packed(value) << (index * op.bits()))))
        }
        Class::Composed | Class::Modf | Class::Noise(_) | Class::Texture(_) | Class::Emission(_) => None,
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

    fn map(&self, op: Unary) -> Option<Scalars> {
        self.each(|x| Some(Float(op.of(f64::from(as_float(&x)?)) as f32)))
    }

    fn map2(&self, op: Binary) -> Option<Scalars> {
        componentwise(self.operand(0)?, self.operand(1)?, |x, y| {
            Some(Float(op.of(f64::from(as_float(&x)?), f64::from(as_float(&y)?)) as f32))
        })
    }

    /// Applies a function of three arguments, some of which may be scalars combined with vectors.
    fn map3(&self, op: Ternary) -> Option<Scalars> {
        let len = self.operands.iter().map(|operand| operand.scalars.len()).max()?;
        (0..len)
            .map(|index| {
                let value = op.of(self.component(0, index)?, self.component(1, index)?, self.component(2, index)?);
                Some(Float(value as f32))
            })
            .collect()
    }

    fn component(&self, operand: usize, index: usize) -> Option<f64> {
        let scalars = &self.operand(operand)?.scalars;
        let value = if scalars.len() == 1 { scalars.first()? } else { scalars.get(index)? };
        as_float(value).map(f64::from)
    }

    /// Whether the first argument consists of floats.
    fn of_floats(&self) -> Option<bool> {
        Some(matches!(self.operand(0)?.scalars.first()?, Float(_)))
    }

    fn numbers(&self, op: Numbers) -> Option<Scalars> {
        let floats = self.of_floats()?;
        match op {
            Numbers::Atan if self.operands.len() == 2 => self.map2(Binary::Atan2),
            Numbers::Atan => self.map(Unary::Atan),
            Numbers::Abs if floats => self.map(Unary::Abs),
            Numbers::Abs => self.each(|x| if let Int(x) = x { Some(Int(x.wrapping_abs())) } else { None }),
            Numbers::Sign if floats => self.map(Unary::Sign),
            Numbers::Sign => self.each(|x| if let Int(x) = x { Some(Int(x.signum())) } else { None }),
            Numbers::Min if floats => self.map2(Binary::Min),
            Numbers::Min => componentwise(self.operand(0)?, self.operand(1)?, least),
            Numbers::Max if floats => self.map2(Binary::Max),
            Numbers::Max => componentwise(self.operand(0)?, self.operand(1)?, greatest),
            Numbers::Clamp if floats => self.map3(Ternary::Clamp),
            Numbers::Clamp => {
                let raised = componentwise(self.operand(0)?, self.operand(1)?, greatest)?;
                let raised = Operand { ty: self.operand(0)?.ty, scalars: Held::Own(raised) };
                componentwise(&raised, self.operand(2)?, least)
            }
            Numbers::Mix => self.mix(),
        }
    }

    fn mix(&self) -> Option<Scalars> {
        let chooses = matches!(self.operand(2)?.scalars.first(), Some(Bool(_)));
        if !chooses {
            return self.map3(Ternary::Mix);
        }
        let (x, y, a) = (self.operand(0)?, self.operand(1)?, self.operand(2)?);
        let pairs = x.scalars.iter().zip(&*y.scalars);
        Some(pairs.zip(&*a.scalars).map(|((x, y), a)| if *a == Bool(true) { *y } else { *x }).collect())
    }

    /// A function of the bits of integers, with counts that are scalars. A result that counts is an `int`.
    fn bits(&self, op: BitFunction) -> Option<Scalars> {
        let integer = |operand: usize, index: usize| match *self.operand(operand)?.scalars.get(index)? {
            Int(x) => Some((x as u32, true)),
            Uint(x) => Some((x, false)),
            _ => None,
        };
        let scalar = |operand: usize| integer(operand, 0).map_or(0, |(bits, _)| bits);
        let first_count = if op == BitFunction::Insert { 2 } else { 1 };
        let counts = matches!(op, BitFunction::Count | BitFunction::Lowest | BitFunction::Highest);
        (0..self.operand(0)?.scalars.len())
            .map(|index| {
                let (a, signed) = integer(0, index)?;
                let b = if op == BitFunction::Insert { integer(1, index)?.0 } else { 0 };
                let bits = op.of(a, b, scalar(first_count), scalar(first_count + 1), signed);
                Some(if signed || counts { Int(bits as i32) } else { Uint(bits) })
            })
            .collect()
    }

    fn relation(&self, op: Relation) -> Option<Scalars> {
        componentwise(self.operand(0)?, self.operand(1)?, |x, y| {
            Some(Bool(match op {
                Relation::Less => less(x, y)?,
                Relation::LessEqual => less(x, y)? || x == y,
                Relation::Greater => less(y, x)?,
                Relation::GreaterEqual => less(y, x)? || x == y,
                Relation::Equal => x == y,
                Relation::NotEqual => x != y,
            }))
        })
    }

    fn composite(&self, op: Composite) -> Option<Scalars> {
        let x = self.vector(0)?;
        match op {
            Composite::Length => float(dot(&x, &x).sqrt()),
            Composite::Distance => {
                let gap: Vec<f64> = x.iter().zip(&self.vector(1)?).map(|(x, y)| x - y).collect();
                float(dot(&gap, &gap).sqrt())
            }
            Composite::Dot => float(dot(&x, &self.vector(1)?)),
            Composite::Cross => floats(&cross(&x, &self.vector(1)?)?),
            Composite::Normalize => {
                let scale = Unary::Inversesqrt.of(dot(&x, &x));
                floats(&x.iter().map(|component| component * scale).collect::<Vec<_>>())
            }
            Composite::Faceforward => {
                let keeps = dot(&self.vector(2)?, &self.vector(1)?) < 0.0;
                floats(&x.iter().map(|n| if keeps { *n } else { -n }).collect::<Vec<_>>())
            }
            Composite::Reflect => {
                let normal = self.vector(1)?;
                let twice = dot(&normal, &x) * 2.0;
                floats(&x.iter().zip(&normal).map(|(i, n)| i - twice * n).collect::<Vec<_>>())
            }
            Composite::Refract => self.refract(),
            Composite::Determinant => float(determinant(&self.square(0)?)),
            Composite::Inverse => floats(&inverse(&self.square(0)?)),
        }
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
        let along = eta * cosine + Binary::Max.of(k, 0.0).sqrt();
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

/// The same bits as another type.
fn bit_cast(op: BitCast, x: ScalarValue) -> Option<ScalarValue> {
    match (op, x) {
        (BitCast::FloatToInt, Float(x)) => Some(Int(x.to_bits() as i32)),
        (BitCast::FloatToUint, Float(x)) => Some(Uint(x.to_bits())),
        (BitCast::IntToFloat, Int(x)) => Some(Float(f32::from_bits(x as u32))),
        (BitCast::UintToFloat, Uint(x)) => Some(Float(f32::from_bits(x))),
        _ => None,
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

/// The smaller of two integers.
fn least(x: ScalarValue, y: ScalarValue) -> Option<ScalarValue> {
    Some(if less(y, x)? { y } else { x })
}

/// The larger of two integers.
fn greatest(x: ScalarValue, y: ScalarValue) -> Option<ScalarValue> {
    Some(if less(x, y)? { y } else { x })
}

fn less(x: ScalarValue, y: ScalarValue) -> Option<bool> {
    match (x, y) {
        (Int(x), Int(y)) => Some(x < y),
        (Uint(x), Uint(y)) => Some(x < y),
        (Float(x), Float(y)) => Some(x < y),
        _ => None,
    }
}

/// The dot product, summed from left to right.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).reduce(|sum, term| sum + term).unwrap_or(0.0)
}

fn cross(x: &[f64], y: &[f64]) -> Option<[f64; 3]> {
    let (&[x0, x1, x2], &[y0, y1, y2]) = (x, y) else { return None };
    Some([x1 * y2 - y1 * x2, x2 * y0 - y2 * x0, x0 * y1 - y0 * x1])
}

/// The determinant by cofactors of the first column; `columns` is square, 1 to 4 wide. The order of the operations is
/// that of the reference.
fn determinant(columns: &[Vec<f64>]) -> f64 {
    match columns {
        [] => 1.0,
        [only] => only.first().copied().unwrap_or(1.0),
        [first, second] => match (first.as_slice(), second.as_slice()) {
            ([a, b], [c, d]) => a * d - c * b,
            _ => f64::NAN,
        },
        [first, ..] => {
            let term = |row: usize| first.get(row).copied().unwrap_or(f64::NAN) * determinant(&minor(columns, 0, row));
            (1..first.len()).fold(term(0), |sum, row| if row % 2 == 1 { sum - term(row) } else { sum + term(row) })
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

/// The inverse: the adjugate divided by the determinant, by columns.
fn inverse(columns: &[Vec<f64>]) -> Vec<f64> {
    let size = columns.len();
    let determinant_of_all = determinant(columns);
    let mut result = Vec::with_capacity(size * size);
    for column in 0..size {
        for row in 0..size {
            let cofactor = determinant(&minor(columns, row, column));
            let signed = if (column + row) % 2 == 1 { -cofactor } else { cofactor };
            result.push(signed / determinant_of_all);
        }
    }
    result
}
