//! The materials: values of the shader's uniforms.

use glisten::specialize::{Known, ScalarValue};

/// The uniform that changes from frame to frame.
pub(crate) const DYNAMIC: &str = "time";
/// The time of the pictures that are compared.
pub(crate) const TIME: f32 = 0.5;

/// A value of a uniform.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    Int(i32),
    Bool(bool),
    Floats(&'static [f32]),
}

/// Values of all uniforms that do not change from frame to frame; what is not listed is 0.
#[derive(Debug)]
pub(crate) struct Material {
    pub(crate) name: &'static str,
    pub(crate) values: &'static [(&'static str, Value)],
}

use Value::{Bool, Floats, Int};

const SUN: Value = Floats(&[0.48, 0.6, 0.64, 0.9]);
const SUN_AND_SKY: Value = Floats(&[0.48, 0.6, 0.64, 0.8, 0.0, 1.0, 0.0, 0.3]);

pub(crate) const MATERIALS: &[Material] = &[
    Material { name: "clay", values: &[("base_color", Floats(&[0.7, 0.4, 0.3])), ("lights", Int(1)), ("toward", SUN)] },
    Material {
        name: "candy",
        values: &[
            ("kind", Int(1)),
            ("base_color", Floats(&[0.9, 0.1, 0.2])),
            ("second_color", Floats(&[0.9, 0.9, 0.85])),
            ("frequency", Floats(&[6.0])),
            ("lights", Int(1)),
            ("toward", SUN),
            ("shininess", Floats(&[60.0])),
            ("highlight", Floats(&[0.5])),
        ],
    },
    Material {
        name: "marble",
        values: &[
            ("kind", Int(2)),
            ("octaves", Int(2)),
            ("base_color", Floats(&[0.9, 0.88, 0.85])),
            ("second_color", Floats(&[0.3, 0.32, 0.35])),
            ("frequency", Floats(&[5.0])),
            ("lights", Int(2)),
            ("toward", SUN_AND_SKY),
            ("rim", Bool(true)),
            ("rim_power", Floats(&[3.0])),
        ],
    },
];

impl Material {
    /// The scalars of a uniform.
    pub(crate) fn scalars(&self, name: &str, count: usize, like: ScalarValue) -> Vec<ScalarValue> {
        let given = self.values.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
        let mut scalars = match given {
            Some(Int(value)) => vec![ScalarValue::Int(value)],
            Some(Bool(value)) => vec![ScalarValue::Bool(value)],
            Some(Floats(values)) => values.iter().map(|value| ScalarValue::Float(*value)).collect(),
            None => Vec::new(),
        };
        scalars.resize(count, like);
        scalars
    }

    /// The values of a program's inputs while this material is drawn.
    pub(crate) fn known(&self, program: &glisten::Program) -> Known {
        let mut known = Known::default();
        for leaf in program.interface.uniforms.iter().filter(|leaf| leaf.name != DYNAMIC) {
            let Some(scalar) = program.types.scalar_of(leaf.ty) else { continue };
            let count = program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1);
            known.uniforms.insert(leaf.name.clone(), self.scalars(&leaf.name, count as usize, zero(scalar.name())));
        }
        known
    }
}

/// 0 of a scalar type.
pub(crate) fn zero(scalar: &str) -> ScalarValue {
    match scalar {
        "int" => ScalarValue::Int(0),
        "uint" => ScalarValue::Uint(0),
        "bool" => ScalarValue::Bool(false),
        _ => ScalarValue::Float(0.0),
    }
}
