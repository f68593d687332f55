//! Uniform values by name (GLSL 1.50 §4.3.5, OpenGL 3.2 §2.11.4).
//!
//! *In:* a linked program. *Out:* [`UniformValues`], flat by root, and the [`LeafShape`] that a host needs to write
//! them.
//!
//! *Holds:* a uniform that is not set keeps its initializer, or is 0. Values have the types that the program
//! declares.

use glisten_front::hir::{ArraySize, Scalar, ScalarValue, Type, TypeId, Types};
use glisten_front::link::{Program, UniformLeaf};

/// The order of the values of a leaf: element by element, column by column, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeafShape {
    /// The type of each value.
    pub scalar: Scalar,
    /// The columns of a matrix; 1 for scalars and vectors.
    pub columns: u32,
    /// The rows of a matrix, the components of a vector; 1 for scalars.
    pub rows: u32,
    /// The elements of an array; 1 for anything else.
    pub elements: u32,
}

impl LeafShape {
    /// The shape of a leaf; `None` if it has no values, such as an opaque type.
    pub fn of(types: &Types, leaf: &UniformLeaf) -> Option<Self> {
        let elements = leaf.array_size.unwrap_or(1);
        let (scalar, columns, rows) = match types.get(leaf.ty) {
            Type::Scalar(scalar) => (scalar, 1, 1),
            Type::Vector(scalar, size) => (scalar, 1, u32::from(size)),
            Type::Matrix(columns, rows) => (Scalar::Float, u32::from(columns), u32::from(rows)),
            _ => return None,
        };
        Some(Self { scalar, columns, rows, elements })
    }

    /// The number of values in an element.
    pub fn n_each(self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// The number of values in the leaf.
    pub fn n_values(self) -> usize {
        self.n_each() * self.elements as usize
    }
}

/// The 32 bits of a value in a buffer; a boolean is 0 or 1.
pub fn bits(value: ScalarValue) -> u32 {
    match value {
        ScalarValue::Bool(value) => u32::from(value),
        ScalarValue::Int(value) => value.cast_unsigned(),
        ScalarValue::Uint(value) => value,
        ScalarValue::Float(value) => value.to_bits(),
    }
}

/// The values of a leaf within those of the roots; empty if they are missing.
pub fn of_leaf<'a>(roots: &'a [Vec<ScalarValue>], leaf: &UniformLeaf, shape: LeafShape) -> &'a [ScalarValue] {
    let start = leaf.flat_offset as usize;
    let root = roots.get(leaf.root.0 as usize).map_or(&[][..], Vec::as_slice);
    root.get(start..start + shape.n_values()).unwrap_or(&[])
}

/// The values of all uniforms of a program, flat by root, in the order of the interface.
#[derive(Clone, Debug, PartialEq)]
pub struct UniformValues {
    /// The values for a [`Draw`](crate::Draw).
    pub roots: Vec<Vec<ScalarValue>>,
}

impl UniformValues {
    /// The values of the initializers, otherwise 0.
    pub fn initial(program: &Program) -> Self {
        let root = |root: &glisten_front::link::UniformRoot| {
            let mut zero = Vec::new();
            zeros(&program.types, root.ty, &mut zero);
            let initializer = root.default.as_ref().map(|value| &value.scalars);
            initializer.filter(|scalars| scalars.len() == zero.len()).cloned().unwrap_or(zero)
        };
        Self { roots: program.interface.roots.iter().map(root).collect() }
    }

    /// Finds the leaf with a name, and the element that an index in the name selects: `lights[1].color`, `weights`,
    /// `weights[2]`. An index above the last element is returned unchanged.
    pub fn find<'p>(program: &'p Program, name: &str) -> Option<(&'p UniformLeaf, Option<u32>)> {
        let leaf = |name: &str| program.interface.uniforms.iter().find(|leaf| leaf.name == name);
        if let Some(leaf) = leaf(name) {
            return Some((leaf, None));
        }
        let (array, index) = name.strip_suffix(']')?.rsplit_once('[')?;
        let element = index.parse().ok()?;
        leaf(array).filter(|leaf| leaf.array_size.is_some()).map(|leaf| (leaf, Some(element)))
    }

    /// Sets values of a leaf from value `first`. Returns `false`, and sets nothing, if they do not fit.
    pub fn set(&mut self, leaf: &UniformLeaf, first: usize, values: &[ScalarValue]) -> bool {
        let start = leaf.flat_offset as usize + first;
        let root = self.roots.get_mut(leaf.root.0 as usize);
        let Some(room) = root.and_then(|root| root.get_mut(start..start + values.len())) else { return false };
        room.copy_from_slice(values);
        true
    }
}

/// Appends the zeros of a type.
fn zeros(types: &Types, ty: TypeId, into: &mut Vec<ScalarValue>) {
    match types.get(ty) {
        Type::Scalar(scalar) | Type::Vector(scalar, _) => {
            let zero = match scalar {
                Scalar::Bool => ScalarValue::Bool(false),
                Scalar::Int => ScalarValue::Int(0),
                Scalar::Uint => ScalarValue::Uint(0),
                Scalar::Float => ScalarValue::Float(0.0),
            };
            into.extend(std::iter::repeat_n(zero, types.flat_len(ty) as usize));
        }
        Type::Matrix(..) => into.extend(std::iter::repeat_n(ScalarValue::Float(0.0), types.flat_len(ty) as usize)),
        Type::Sampler(_) => into.push(ScalarValue::Int(0)),
        Type::Struct(id) => types.structure(id).members.iter().for_each(|member| zeros(types, member.ty, into)),
        Type::Array(element, ArraySize::Sized(size)) => (0..size).for_each(|_| zeros(types, element, into)),
        Type::Error | Type::Void | Type::Array(..) => {}
    }
}

/// The numbers that fill a [`value_text`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// 0 and `false`.
    Zero,
    /// 1 and `true`.
    One,
}

/// A value to begin with, as a scene file has it: a matrix is the identity, all else is filled. `[..]` stands for more than
/// `most` numbers, and for a leaf without values.
pub fn value_text(types: &Types, leaf: &UniformLeaf, fill: Fill, most: usize) -> String {
    let Some(shape) = LeafShape::of(types, leaf) else { return "[..]".to_owned() };
    let text = |one: bool| match (shape.scalar, one) {
        (Scalar::Bool, one) => {
            if one {
                "true"
            } else {
                "false"
            }
        }
        (Scalar::Int | Scalar::Uint, one) => {
            if one {
                "1"
            } else {
                "0"
            }
        }
        (Scalar::Float, one) => {
            if one {
                "1.0"
            } else {
                "0.0"
            }
        }
    };
    let each = shape.n_each();
    if each * shape.elements as usize > most {
        return "[..]".to_owned();
    }
    let (rows, is_matrix) = (shape.rows as usize, shape.columns > 1);
    let element: Vec<&str> =
        (0..each).map(|k| text(if is_matrix { k / rows == k % rows } else { fill == Fill::One })).collect();
    match (&element[..], leaf.array_size) {
        ([one], None) => (*one).to_owned(),
        _ => format!("[{}]", element.repeat(shape.elements as usize).join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_front::{Compiler, Options, Source, Stage};

    fn program() -> Program {
        let text = "#version 150\nstruct Light { vec3 color; bool on; };\nuniform Light light[2];\n\
                    uniform mat2x3 m[2];\nuniform float given = 0.5;\nuniform int weights[3];\nout vec4 c;\n\
                    void main() { c = vec4(light[1].color, m[0][0].x + given + float(weights[2])); }\n";
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        Compiler::new(Options::default()).compile(&[source]).program.expect("it is valid")
    }

    #[test]
    fn values_are_initializers_or_zeros_of_the_declared_types() {
        let program = program();
        let values = UniformValues::initial(&program);
        let of = |name: &str| {
            let (leaf, _) = UniformValues::find(&program, name).expect("it is declared");
            of_leaf(&values.roots, leaf, LeafShape::of(&program.types, leaf).expect("it has values")).to_vec()
        };
        assert_eq!(of("given"), [ScalarValue::Float(0.5)]);
        assert_eq!(of("light[1].on"), [ScalarValue::Bool(false)]);
        assert_eq!(of("weights"), [ScalarValue::Int(0); 3]);
        assert_eq!(of("m"), [ScalarValue::Float(0.0); 12]);
    }

    #[test]
    fn names_select_leaves_and_elements_and_values_stay_in_their_room() {
        let program = program();
        let mut values = UniformValues::initial(&program);
        let (leaf, element) = UniformValues::find(&program, "weights[2]").expect("it is declared");
        assert_eq!((leaf.name.as_str(), element), ("weights", Some(2)));
        assert!(values.set(leaf, 2, &[ScalarValue::Int(7)]));
        assert!(!values.set(leaf, 2, &[ScalarValue::Int(8); 2]), "only one value is left");
        let shape = LeafShape::of(&program.types, leaf).expect("it has values");
        assert_eq!(of_leaf(&values.roots, leaf, shape), [0, 0, 7].map(ScalarValue::Int));
        assert!(UniformValues::find(&program, "given[0]").is_none() && UniformValues::find(&program, "w").is_none());
        let (matrix, _) = UniformValues::find(&program, "m").expect("it is declared");
        let shape = LeafShape::of(&program.types, matrix).expect("it has values");
        assert_eq!((shape.columns, shape.rows, shape.elements, shape.n_values()), (2, 3, 2, 12));
        assert_eq!([ScalarValue::Bool(true), ScalarValue::Int(-1)].map(bits), [1, u32::MAX]);
    }
}
