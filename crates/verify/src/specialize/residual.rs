//! A scene with residual programs.
//!
//! *In:* a scene and the texts of its programs. *Out:* the scene that is left: for each draw the residual program, and of its
//! data only what that reads.
//! *Holds:* equal residuals are one program.

use super::known::{known, leaf_values};
use glisten_front::hir::{ScalarValue, Stage};
use glisten_front::link::{Interface, Program};
use glisten_front::source::{SourceMap, Span};
use glisten_scene::dynamic::{names_anything, names_element};
use glisten_scene::{AttributeData, AttributeValues, Draw, Scene};
use glisten_specialize::{Extent, LeftOut, Math, Moved, Options, Residual};
use glisten_variants::{specialize_smallest, spirv_instructions};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The changes that a specialization may make to a picture. The default allows none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contract {
    /// What is taken for granted of numbers, and the algebra that is allowed.
    pub math: Math,
    /// Computations that move to the vertex stage.
    pub move_to_vertex: bool,
}

impl Contract {
    /// Whether the picture stays as it is, bit by bit, whatever the inputs are.
    pub fn is_exact(self) -> bool {
        self == Self::default()
    }
}

/// A scene of residual programs.
#[derive(Clone, Debug)]
pub struct SpecializedScene {
    /// How it was specialized.
    pub contract: Contract,
    /// The scene.
    pub scene: Scene,
    /// What became of each draw's program.
    pub draws: Vec<SpecializedDraw>,
}

impl SpecializedScene {
    /// Whether the residual programs have fewer instructions than those of the original.
    pub fn is_shorter_than(&self, original: &Scene) -> bool {
        let instructions =
            |scene: &Scene| -> u64 { scene.draws.iter().map(|draw| spirv_instructions(&draw.program)).sum() };
        instructions(&self.scene) < instructions(original)
    }
}

/// What became of a draw's program.
#[derive(Clone, Debug)]
pub struct SpecializedDraw {
    /// The residual's texts, by stage.
    pub texts: Vec<(Stage, String)>,
    /// For each line of each text the place in the original that it comes from.
    pub lines: Vec<(Stage, Vec<Span>)>,
    /// What was left out.
    pub left_out: Vec<LeftOut>,
    /// What moved to the vertex stage.
    pub moved: Vec<Moved>,
    /// The texts that the residual was read back from, for diagnostics about it.
    pub sources: SourceMap,
    /// How far it was evaluated: less than all where the residual would have been longer than the original.
    pub extent: Extent,
    /// Why the program was left as it was, should that ever be.
    pub fault: Option<String>,
}

impl SpecializedDraw {
    /// The text of a stage.
    pub fn text(&self, stage: Stage) -> &str {
        self.texts.iter().find(|(of, _)| *of == stage).map_or("", |(_, text)| text)
    }

    /// The places in the original that the lines of a stage's text come from.
    pub fn places(&self, stage: Stage) -> &[Span] {
        self.lines.iter().find(|(of, _)| *of == stage).map_or(&[], |(_, lines)| lines)
    }
}

/// The text of each stage of a program.
type StageTexts = Vec<(Stage, String)>;

/// Leaves out of a scene what its picture does not need. `dynamic` is added to what the draws call so.
pub fn specialize_scene(scene: &Scene, sources: &SourceMap, dynamic: &[String]) -> SpecializedScene {
    specialize_scene_by(Contract::default(), scene, sources, dynamic)
}

/// Leaves out of a scene what its picture does not need, or what `contract` allows besides.
pub fn specialize_scene_by(
    contract: Contract,
    scene: &Scene,
    sources: &SourceMap,
    dynamic: &[String],
) -> SpecializedScene {
    specialize_to(Extent::default(), contract, scene, sources, dynamic)
}

/// The scene with its programs as they are, but for what reaches no output.
pub fn unspecialized_scene(scene: &Scene, sources: &SourceMap, dynamic: &[String]) -> SpecializedScene {
    specialize_to(Extent::Nothing, Contract::default(), scene, sources, dynamic)
}

fn specialize_to(
    extent: Extent,
    contract: Contract,
    scene: &Scene,
    sources: &SourceMap,
    dynamic: &[String],
) -> SpecializedScene {
    let options = Options {
        extent,
        sources: Some(sources),
        math: contract.math,
        move_to_vertex: contract.move_to_vertex,
        kept: &[],
    };
    let mut draws = Vec::with_capacity(scene.draws.len());
    let mut residuals: Vec<(StageTexts, Arc<Program>)> = Vec::new();
    let mut result = scene.clone();
    result.draws.clear();
    for draw in &scene.draws {
        let known = known(draw, &scene.framebuffer, dynamic);
        let Residual { stages, program, left_out, moved, sources, extent, fault, .. } =
            specialize_smallest(&draw.program, &known, &options);
        let lines = stages.iter().map(|stage| (stage.stage, stage.lines.clone())).collect();
        let texts: StageTexts = stages.into_iter().map(|stage| (stage.stage, stage.text)).collect();
        let program = match residuals.iter().find(|(known, other)| *known == texts && alike(other, &program)) {
            Some((_, program)) => Arc::clone(program),
            None => {
                let program = Arc::new(program);
                residuals.push((texts.clone(), Arc::clone(&program)));
                program
            }
        };
        result.draws.push(with_program(draw, program, dynamic));
        draws.push(SpecializedDraw { texts, lines, left_out, moved, sources, extent, fault });
    }
    SpecializedScene { contract, scene: result, draws }
}

/// Whether two programs of one text have the same locations.
fn alike(a: &Program, b: &Program) -> bool {
    let places = |program: &Program| -> Vec<(String, u32)> {
        let attributes = program.interface.attributes.iter().map(|one| (one.name.clone(), one.location));
        attributes.chain(program.interface.outputs.iter().map(|one| (one.name.clone(), one.location))).collect()
    };
    places(a) == places(b)
}

/// A draw with another program, whose inputs are found by their names: data that it does not declare is left, and what only
/// it declares has none. `dynamic` is added to the draw's own list, of which the names stay that the program has.
pub fn with_program(draw: &Draw, program: Arc<Program>, dynamic: &[String]) -> Draw {
    let (old, new) = (&draw.program.interface, &program.interface);
    let attributes = new.attributes.iter().map(|attribute| {
        let index = old.attributes.iter().position(|known| known.name == attribute.name)?;
        draw.attributes.get(index).cloned().flatten()
    });
    let attributes: Vec<Option<AttributeData>> = attributes.collect();
    let mut uniforms: Vec<Vec<ScalarValue>> =
        new.roots.iter().map(|root| vec![ScalarValue::Float(0.0); program.types.flat_len(root.ty) as usize]).collect();
    for leaf in &new.uniforms {
        let Some(known) = old.uniforms.iter().find(|known| known.name == leaf.name) else { continue };
        let Some(values) = leaf_values(draw, known) else { continue };
        let len = (program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1)) as usize;
        let start = leaf.flat_offset as usize;
        let slots = uniforms.get_mut(leaf.root.0 as usize).and_then(|root| root.get_mut(start..start + len));
        slots.into_iter().flatten().zip(values).for_each(|(slot, value)| *slot = *value);
    }
    let textures = new.samplers.iter().map(|slot| {
        let index = old.samplers.iter().position(|known| known.name == slot.name)?;
        draw.textures.get(index).cloned().flatten()
    });
    let textures = textures.collect();
    let mut names: Vec<String> = draw.dynamic.clone();
    names.extend(dynamic.iter().filter(|name| !draw.dynamic.contains(name)).cloned());
    names = names.iter().filter_map(|name| left_name(old, new, name)).collect();
    let mut told = BTreeSet::new();
    names.retain(|name| told.insert(name.clone()));
    let drawn = Draw { attributes, uniforms, textures, dynamic: names, program, ..draw.clone() };
    without_unused_vertices(drawn)
}

/// A name of `dynamic` as a program has it: of an element of an array the whole array, whose end may be gone. None if nothing
/// of it is left.
fn left_name(old: &Interface, new: &Interface, name: &str) -> Option<String> {
    let whole = old.uniforms.iter().find(|leaf| names_element(name, leaf)).map(|leaf| leaf.name.as_str());
    let name = whole.unwrap_or(name);
    names_anything(new, name).then(|| name.to_owned())
}

/// Of an attribute that has more components than its vector the others are dropped.
fn without_unused_vertices(draw: Draw) -> Draw {
    let mut draw = draw;
    for (attribute, data) in draw.program.interface.attributes.iter().zip(&mut draw.attributes) {
        let declared = draw.program.types.flat_len(attribute.ty);
        if let Some(data) = data
            && data.size > declared
        {
            *data = AttributeData {
                size: declared,
                divisor: data.divisor,
                values: narrowed(&data.values, data.size, declared),
            };
        }
    }
    draw
}

fn narrowed(values: &AttributeValues, size: u32, declared: u32) -> AttributeValues {
    fn rows<T: Copy>(values: &[T], size: u32, declared: u32) -> Vec<T> {
        values.chunks(size.max(1) as usize).flat_map(|row| row.iter().copied().take(declared as usize)).collect()
    }
    match values {
        AttributeValues::Float(values) => AttributeValues::Float(rows(values, size, declared)),
        AttributeValues::Int(values) => AttributeValues::Int(rows(values, size, declared)),
        AttributeValues::Uint(values) => AttributeValues::Uint(rows(values, size, declared)),
    }
}
