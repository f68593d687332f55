//! `inverse`, which WGSL lacks.
//!
//! *In:* the square matrices that a module inverts. *Out:* a function for each kind of them.

use naga::{Expression, MathFunction, Module, Scalar, TypeInner, VectorSize};

/// The square matrices that a module inverts, each with the function for it.
#[derive(Default)]
pub(super) struct Inverses {
    found: Vec<(VectorSize, Scalar)>,
}

const SIZES: [VectorSize; 3] = [VectorSize::Bi, VectorSize::Tri, VectorSize::Quad];
/// The names of the functions, for each size and both widths.
const NAMES: [[&str; 2]; 3] = [
    ["inverse_2x2_f32", "inverse_2x2_f16"],
    ["inverse_3x3_f32", "inverse_3x3_f16"],
    ["inverse_4x4_f32", "inverse_4x4_f16"],
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
    pub(super) fn text(&self) -> String {
        self.found.iter().filter_map(|(size, scalar)| text(*size, *scalar)).collect()
    }
}

/// The function for one kind of matrix: the adjugate over the determinant.
fn text(size: VectorSize, scalar: Scalar) -> Option<String> {
    let body = match size {
        VectorSize::Bi => TWO,
        VectorSize::Tri => THREE,
        VectorSize::Quad => FOUR,
    };
    let (name, letter) = (name((size, scalar))?, if scalar.width == 2 { "h" } else { "f" });
    let side = size as u8;
    let ty = format!("mat{side}x{side}{letter}");
    Some(format!("\nfn {name}(m: {ty}) -> {ty} {{\n{}}}\n", body.replace('@', letter)))
}

/// `@` stands for the letter of the type of the scalars.
const TWO: &str = "    let a = m[0];
    let b = m[1];
    return mat2x2@(b.y, -a.y, -b.x, a.x) * (1.0 / (a.x * b.y - b.x * a.y));
";

/// The rows are the cross products of two columns each.
const THREE: &str = "    let x = cross(m[1], m[2]);
    let y = cross(m[2], m[0]);
    let z = cross(m[0], m[1]);
    return transpose(mat3x3@(x, y, z)) * (1.0 / dot(m[0], x));
";

/// Minors of two of the first two columns and of the last two make all cofactors, and the determinant.
const FOUR: &str = "    let a = m[0];
    let b = m[1];
    let c = m[2];
    let d = m[3];
    let p = vec3@(a.x, a.x, a.x) * b.yzw - vec3@(b.x, b.x, b.x) * a.yzw;
    let q = a.yyz * b.zww - b.yyz * a.zww;
    let r = vec3@(c.x, c.x, c.x) * d.yzw - vec3@(d.x, d.x, d.x) * c.yzw;
    let s = c.yyz * d.zww - d.yyz * c.zww;
    let determinant = p.x * s.z - p.y * s.y + p.z * s.x + q.x * r.z - q.y * r.y + q.z * r.x;
    return mat4x4@(
        vec4@(b.y * s.z - b.z * s.y + b.w * s.x, a.z * s.y - a.y * s.z - a.w * s.x,
            d.y * q.z - d.z * q.y + d.w * q.x, c.z * q.y - c.y * q.z - c.w * q.x),
        vec4@(b.z * r.z - b.x * s.z - b.w * r.y, a.x * s.z - a.z * r.z + a.w * r.y,
            d.z * p.z - d.x * q.z - d.w * p.y, c.x * q.z - c.z * p.z + c.w * p.y),
        vec4@(b.x * s.y - b.y * r.z + b.w * r.x, a.y * r.z - a.x * s.y - a.w * r.x,
            d.x * q.y - d.y * p.z + d.w * p.x, c.y * p.z - c.x * q.y - c.w * p.x),
        vec4@(b.y * r.y - b.x * s.x - b.z * r.x, a.x * s.x - a.y * r.y + a.z * r.x,
            d.y * p.y - d.x * q.x - d.z * p.x, c.x * q.x - c.y * p.y + c.z * p.x),
    ) * (1.0 / determinant);
";

#[cfg(test)]
mod tests {
    use super::{SIZES, text};
    use naga::Scalar;

    /// naga reads each function, as WGSL without any of its own.
    #[test]
    fn the_functions_are_wgsl() {
        for size in SIZES {
            let text = text(size, Scalar::F32).expect("a function");
            naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
            let half = super::text(size, Scalar::F16).expect("a function");
            naga::front::wgsl::parse_str(&format!("enable f16;\n{half}"))
                .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&half)));
        }
    }
}
