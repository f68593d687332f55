//! Uniform values that a test sets by name.

use super::words::Words;
use super::{TestResult, fail, skip};
use glisten_front::hir::{Scalar, ScalarValue};
use glisten_front::link::{Program, UniformLeaf};
use glisten_scene::values::{LeafShape, UniformValues};

/// The values of a program's uniforms, flat by root, and the unit of each sampler.
#[derive(Clone, Debug)]
pub(super) struct Uniforms {
    pub(super) values: UniformValues,
    /// The unit of each sampler slot.
    pub(super) units: Vec<u32>,
}

impl Uniforms {
    /// The values of the initializers, or 0.
    pub(super) fn new(program: &Program) -> Self {
        let values = UniformValues::initial(program);
        let units = program.interface.samplers.iter().map(|slot| slot.unit.unwrap_or(0)).collect();
        Self { values, units }
    }

    /// Runs `uniform vec4 name 0 1 0 1`; `element` selects a block of an array of blocks.
    pub(super) fn set(&mut self, program: &Program, words: &mut Words<'_>, element: u32) -> Result<(), TestResult> {
        let line = words.line;
        let ty = words.word()?;
        let name = words.word()?;
        if ty == "double" || ty.starts_with('d') || ty.contains("64") {
            return skip(line, format_args!("uniforms of type `{ty}`"));
        }
        if self.set_unit(program, name, words)? {
            return Ok(());
        }
        let Some((leaf, first)) = find(program, name, element) else {
            // A uniform that a compiler may call inactive has no location, and setting it is not an error.
            return if is_declared(program, name) {
                Ok(())
            } else {
                fail(line, format_args!("there is no uniform `{name}`"))
            };
        };
        let Some(shape) = LeafShape::of(&program.types, leaf) else { return Ok(()) };
        let mut numbers = Vec::new();
        while !words.rest().is_empty() {
            let value = if shape.scalar.is_integer() { words.integer()? } else { words.number()? };
            numbers.push(number(shape.scalar, value));
        }
        if first as usize + numbers.len() > shape.n_values() || !self.values.set(leaf, first as usize, &numbers) {
            return fail(line, format_args!("more values than `{name}` holds"));
        }
        Ok(())
    }

    /// Runs `uniform int name 1` for a sampler; an array takes one unit per element.
    fn set_unit(&mut self, program: &Program, name: &str, words: &mut Words<'_>) -> Result<bool, TestResult> {
        let slots = &program.interface.samplers;
        let element = |index: usize| format!("{name}[{index}]");
        let Some(first) = slots.iter().position(|slot| slot.name == name || slot.name == element(0)) else {
            return Ok(false);
        };
        let mut index = 0;
        while !words.rest().is_empty() {
            let unit = words.count()?;
            if let Some(slot) = self.units.get_mut(first + index) {
                *slot = unit;
            }
            index += 1;
        }
        Ok(true)
    }
}

fn number(scalar: Scalar, value: f64) -> ScalarValue {
    match scalar {
        Scalar::Bool => ScalarValue::Bool(value != 0.0),
        // Bits beyond the 32nd are dropped, as in OpenGL's own call.
        Scalar::Int => ScalarValue::Int(value as i64 as i32),
        Scalar::Uint => ScalarValue::Uint(value as i64 as u32),
        Scalar::Float => ScalarValue::Float(value as f32),
    }
}

/// The leaf of a name, and the index of the scalar that an array index in the name selects.
pub(super) fn find<'p>(program: &'p Program, name: &str, element: u32) -> Option<(&'p UniformLeaf, u32)> {
    let leaves = &program.interface.uniforms;
    let picked = |leaf: &&UniformLeaf| leaf.block_element == element || is_indexed(leaf, name);
    let exact = |wanted: &str| {
        leaves.iter().filter(picked).find(|leaf| without_block_index(leaf) == wanted || leaf.name == wanted)
    };
    if let Some(leaf) = exact(name) {
        return Some((leaf, 0));
    }
    let (array, index) = name.strip_suffix(']')?.rsplit_once('[')?;
    let leaf = exact(array)?;
    let index: u32 = index.parse().ok()?;
    (index < leaf.array_size?).then(|| (leaf, index * program.types.flat_len(leaf.ty)))
}

/// Whether the name in the test has the index of the block's element.
fn is_indexed(leaf: &UniformLeaf, name: &str) -> bool {
    name.starts_with(leaf.name.split('.').next().unwrap_or_default())
}

/// `Block.member` for `Block[1].member`.
fn without_block_index(leaf: &UniformLeaf) -> String {
    match (leaf.name.split_once('.'), leaf.name.find('[')) {
        // `Block[1][0].member` of an array of arrays, too.
        (Some((block, member)), Some(open)) if open < block.len() => {
            format!("{}.{member}", block.get(..open).unwrap_or(block))
        }
        _ => leaf.name.clone(),
    }
}

/// Whether a name begins with something that the program declares.
fn is_declared(program: &Program, name: &str) -> bool {
    let head = name.split(['.', '[']).next().unwrap_or_default();
    program.stages.iter().flat_map(|shader| shader.globals()).any(|(_, global)| global.name == head)
}
