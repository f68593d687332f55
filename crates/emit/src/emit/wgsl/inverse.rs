//! `inverse`, which WGSL lacks: the functions that naga's writer uses for it.
//!
//! *Holds:* the text is naga's own, taken from what it writes for a module with nothing else in it.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Expression, Function, FunctionArgument, FunctionResult, MathFunction, Module, Scalar, Span, Statement};
use naga::{Type, TypeInner, VectorSize};

/// The square matrices that a module inverts, each with naga's function for it.
#[derive(Default)]
pub(super) struct Inverses {
    found: Vec<(VectorSize, Scalar)>,
}

const SIZES: [VectorSize; 3] = [VectorSize::Bi, VectorSize::Tri, VectorSize::Quad];
/// The names of naga's functions, for each size and both widths.
const NAMES: [[&str; 2]; 3] = [
    ["_naga_inverse_2x2_f32", "_naga_inverse_2x2_f16"],
    ["_naga_inverse_3x3_f32", "_naga_inverse_3x3_f16"],
    ["_naga_inverse_4x4_f32", "_naga_inverse_4x4_f16"],
];

fn name((size, scalar): (VectorSize, Scalar)) -> Option<&'static str> {
    let row = SIZES.iter().position(|other| *other == size)?;
    NAMES.get(row)?.get(usize::from(scalar.width == 2)).copied()
}

fn square(ty: &TypeInner) -> Option<(VectorSize, Scalar)> {
    match *ty {
        TypeInner::Matrix { columns, rows, scalar } if columns == rows => Some((columns, scalar)),
        _ => None,
    }
}

impl Inverses {
    /// Those of a module.
    pub(super) fn of(module: &Module, info: &naga::valid::ModuleInfo) -> Self {
        let mut inverses = Self::default();
        let functions = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
        let entries = module.entry_points.iter().enumerate();
        let entries = entries.map(|(index, entry)| (&entry.function, info.get_entry_point(index)));
        for (function, info) in functions.chain(entries) {
            for (_, expression) in function.expressions.iter() {
                let Expression::Math { fun: MathFunction::Inverse, arg, .. } = *expression else { continue };
                let found = square(info[arg].ty.inner_with(&module.types));
                inverses.found.extend(found.filter(|found| !inverses.found.contains(found)));
            }
        }
        inverses
    }

    /// The name of the function for a matrix.
    pub(super) fn name(&self, ty: &TypeInner) -> Option<&'static str> {
        square(ty).and_then(name)
    }

    /// The names of all functions in the text, which nothing else in the module may have.
    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.found.iter().copied().filter_map(name)
    }

    /// The functions.
    pub(super) fn text(&self) -> Result<String, String> {
        let texts: Result<Vec<String>, String> = self.found.iter().map(|(size, scalar)| text(*size, *scalar)).collect();
        Ok(texts?.concat())
    }
}

/// naga's function for one kind of matrix.
fn text(size: VectorSize, scalar: Scalar) -> Result<String, String> {
    let mut module = Module::default();
    let inner = TypeInner::Matrix { columns: size, rows: size, scalar };
    let ty = module.types.insert(Type { name: None, inner }, Span::UNDEFINED);
    let mut function = Function {
        name: Some("f".to_owned()),
        arguments: vec![FunctionArgument { name: Some("m".to_owned()), ty, binding: None }],
        result: Some(FunctionResult { ty, binding: None }),
        ..Function::default()
    };
    let arg = function.expressions.append(Expression::FunctionArgument(0), Span::UNDEFINED);
    let inverse = Expression::Math { fun: MathFunction::Inverse, arg, arg1: None, arg2: None, arg3: None };
    let before = function.expressions.len();
    let value = function.expressions.append(inverse, Span::UNDEFINED);
    function.body.push(Statement::Emit(function.expressions.range_from(before)), Span::UNDEFINED);
    function.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
    module.functions.append(function, Span::UNDEFINED);
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
    let info = info.map_err(|error| error.to_string())?;
    let flags = naga::back::wgsl::WriterFlags::empty();
    let text = naga::back::wgsl::write_string(&module, &info, flags).map_err(|error| error.to_string())?;
    let start = text.find("fn _naga_inverse").ok_or("naga has no inverse")?;
    Ok(format!("\n{}\n", text[start..].trim_end()))
}
