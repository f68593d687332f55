//! Uniform values that a test sets by name.

use super::known;
use super::words::Words;
use super::{TestResult, fail, skip};
use crate::numeric::{Shape, TYPES};
use glisten_front::hir::{ArraySize, Scalar, ScalarValue, Storage, Type, TypeId, Types};
use glisten_front::link::{Program, UniformLeaf};
use glisten_scene::values::{LeafShape, UniformValues};

/// How a type begins that this runner does not support.
const UNSUPPORTED: &[&str] = &["double", "dvec", "dmat", "int64", "uint64", "i64vec", "u64vec", "handle"];

/// The values of a program's uniforms, flat by root, and the unit of each sampler.
#[derive(Clone, Debug)]
pub(super) struct Uniforms {
    pub(super) values: UniformValues,
    /// The unit of each sampler slot.
    pub(super) units: Vec<u32>,
    /// The first value that lacks numbers. shader_runner takes what is in its memory, so it is told with a probe that fails.
    pub(super) short: Option<String>,
}

impl Uniforms {
    /// The values of the initializers, or 0.
    pub(super) fn new(program: &Program) -> Self {
        let values = UniformValues::initial(program);
        let units = program.interface.samplers.iter().map(|slot| slot.unit.unwrap_or(0)).collect();
        Self { values, units, short: None }
    }

    /// Runs `uniform vec4 name 0 1 0 1`; `element` selects a block of an array of blocks.
    pub(super) fn set(&mut self, program: &Program, words: &mut Words<'_>, element: u32) -> Result<(), TestResult> {
        let line = words.line;
        let ty = words.word()?;
        let name = words.word()?;
        if UNSUPPORTED.iter().any(|prefix| ty.starts_with(prefix)) {
            return skip(line, format_args!("uniforms of type `{ty}`"));
        }
        let Some(Shape { scalar, columns, rows }) = Shape::named(ty) else {
            return known::mistake(line, ty, "a type of a uniform", TYPES.iter().map(|row| row.0));
        };
        if self.set_unit(program, ty, name, words)? {
            return Ok(());
        }
        let Some((leaf, first)) = find(program, name, element) else {
            // A uniform that a compiler may call inactive has no location, and setting it is not an error.
            words.pass_over();
            return if is_declared(program, name) { Ok(()) } else { no_uniform(program, line, name) };
        };
        let Some(shape) = LeafShape::of(&program.types, leaf) else {
            words.pass_over();
            return Ok(());
        };
        let is_loose = program.interface.roots.get(leaf.root.0 as usize).is_none_or(|root| root.block.is_none());
        // A boolean takes numbers of every type (OpenGL 3.2 §2.11.4); a block takes bytes.
        let is_bool = scalar == Scalar::Bool || shape.scalar == Scalar::Bool;
        let fits = (shape.columns, shape.rows) == (columns, rows) && (scalar == shape.scalar || is_bool);
        if is_loose && !fits {
            return fail(line, format_args!("`{name}` is a `{}`, not a `{ty}`", program.types.name(leaf.ty)));
        }
        let mut numbers = Vec::new();
        while !words.rest().is_empty() {
            let value = if shape.scalar.is_integer() { words.whole()? } else { words.number()? };
            numbers.push(number(shape.scalar, value));
        }
        let (given, each) = (numbers.len(), shape.n_each());
        if !given.is_multiple_of(each) || given == 0 {
            let missing = format!("line {line}: a `{ty}` has {each} numbers, and {given} are given");
            self.short.get_or_insert(missing);
        }
        if first as usize + numbers.len() > shape.n_values() || !self.values.set(leaf, first as usize, &numbers) {
            return fail(line, format_args!("more values than `{name}` holds"));
        }
        Ok(())
    }

    /// Runs `uniform int name 1` for a sampler; an array takes one unit per element.
    fn set_unit(&mut self, program: &Program, ty: &str, name: &str, words: &mut Words<'_>) -> Result<bool, TestResult> {
        let slots = &program.interface.samplers;
        let start = format!("{name}[0]");
        let Some(first) = slots.iter().position(|slot| slot.name == name || slot.name == start) else {
            return Ok(false);
        };
        if let Some(slot) = slots.get(first).filter(|_| ty != "int") {
            let kind = program.types.name(slot.ty);
            return fail(words.line, format_args!("`{name}` is a `{kind}`, whose unit is an `int`, not a `{ty}`"));
        }
        let array = slots.get(first).and_then(|slot| Some((slot.name.rsplit_once('[')?, slot.array_size?)));
        let elements = array.map_or(1, |((_, index), size)| {
            let index: u32 = index.trim_end_matches(']').parse().unwrap_or(0);
            size.saturating_sub(index) as usize
        });
        let mut units = vec![words.count()?];
        while units.len() < elements && !words.rest().is_empty() {
            units.push(words.count()?);
        }
        self.units.iter_mut().skip(first).zip(units).for_each(|(slot, unit)| *slot = unit);
        Ok(true)
    }
}

/// Fails: a program has no uniform of this name. Says which one may be meant.
fn no_uniform<T>(program: &Program, line: u32, name: &str) -> Result<T, TestResult> {
    let interface = &program.interface;
    let samplers = interface.samplers.iter().map(|slot| slot.name.as_str());
    known::mistake(line, name, "a uniform", interface.uniforms.iter().map(|leaf| leaf.name.as_str()).chain(samplers))
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

/// Whether a name is that of a uniform that the program declares, or of a part of it that has a location.
fn is_declared(program: &Program, name: &str) -> bool {
    let globals = program.stages.iter().flat_map(|shader| shader.globals());
    let mut uniforms = globals.map(|(_, global)| global).filter(|global| global.storage == Storage::Uniform);
    uniforms.any(|global| {
        let part = |rest| names_part(&program.types, global.ty, rest);
        match &global.block {
            // The members of a block without an instance name have their own names.
            Some(block) => part(name.strip_prefix(block.name.as_str()).unwrap_or(name)) || part(&format!(".{name}")),
            None => name.strip_prefix(global.name.as_str()).is_some_and(part),
        }
    })
}

/// Whether what follows the name of a variable of a type is the path to numbers or a sampler in it.
fn names_part(types: &Types, ty: TypeId, path: &str) -> bool {
    match types.get(ty) {
        Type::Struct(id) => {
            let Some(path) = path.strip_prefix('.') else { return false };
            let (name, rest) = path.split_at(path.find(['.', '[']).unwrap_or(path.len()));
            let member = types.structure(id).members.iter().find(|member| member.name == name);
            member.is_some_and(|member| names_part(types, member.ty, rest))
        }
        Type::Array(element, size) => match path.strip_prefix('[').and_then(|path| path.split_once(']')) {
            Some((index, rest)) => {
                let size = if let ArraySize::Sized(size) = size { size } else { u32::MAX };
                index.parse().is_ok_and(|index: u32| index < size) && names_part(types, element, rest)
            }
            None => path.is_empty() && !matches!(types.get(element), Type::Struct(_)) && names_part(types, element, ""),
        },
        _ => path.is_empty(),
    }
}
