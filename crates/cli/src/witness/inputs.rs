//! [`Inputs`]: all that a stage reads: varyings or attributes, and uniforms, each with what is stated about it.
//!
//! *In:* a stage of a program, its texts, ranges by name. *Out:* [`Inputs`]: variables in the order in which a row has their numbers. *Holds:*
//! a range in a comment at the declaration takes precedence over one by name.

use crate::arguments::bounds::Bounds;
use glisten_front::hir::{Global, GlobalId, Interpolation, Scalar, Shader, Stage, Storage, Type, Types};
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_front::source::comments::behind;
use glisten_scene::values::LeafShape;

/// The attributes that a GPU has at least, but for the one that places a point.
const MOST_VARYINGS: usize = 15;

/// An input with its numbers in a row.
#[derive(Clone, Debug)]
pub(super) struct Input {
    /// The name that hosts use.
    pub(super) name: String,
    pub(super) global: GlobalId,
    pub(super) scalar: Scalar,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) elements: usize,
    pub(super) stated: Option<Bounds>,
    /// Where its value goes.
    pub(super) kind: InputKind,
}

/// Where the value of an input goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum InputKind {
    /// To a varying or an attribute, with its qualifiers and type.
    Vertex { declaration: String },
    /// To the uniform with this number in the interface.
    Uniform(usize),
}

/// All inputs of a stage.
#[derive(Debug)]
pub(super) struct Inputs {
    pub(super) all: Vec<Input>,
    /// Whether every varying can be given a value.
    pub(super) is_whole: bool,
}

impl Input {
    pub(super) fn size(&self) -> usize {
        self.columns * self.rows * self.elements
    }

    pub(super) fn is_matrix(&self) -> bool {
        self.columns > 1
    }
}

impl Inputs {
    pub(super) fn of(program: &Program, shader: &Shader, sources: &SourceMap, ranges: &[(String, Bounds)]) -> Self {
        let mut inputs = Self { all: Vec::new(), is_whole: true };
        let types = &program.types;
        let stated = |global: &Global, name: &str| {
            let by_name = ranges.iter().find(|(known, _)| known == name || *known == global.name);
            in_comment(sources, global).or(by_name.map(|(_, bounds)| *bounds))
        };
        for (id, global) in shader.globals() {
            if global.storage != Storage::In || global.builtin.is_some() || !global.used || global.is_fixed() {
                continue;
            }
            match shape(types, global) {
                Some((scalar, columns, rows)) if global.block.is_none() => inputs.all.push(Input {
                    name: global.name.clone(),
                    global: id,
                    scalar,
                    columns,
                    rows,
                    elements: 1,
                    stated: stated(global, &global.name),
                    kind: InputKind::Vertex { declaration: declaration(types, global, shader.stage) },
                }),
                _ => inputs.is_whole = false,
            }
        }
        inputs.is_whole &= inputs.all.iter().map(|input| input.columns).sum::<usize>() <= MOST_VARYINGS;
        for (number, leaf) in program.interface.uniforms.iter().enumerate() {
            let Some(shape) = LeafShape::of(types, leaf) else { continue };
            let root = program.interface.roots.get(leaf.root.0 as usize);
            let global = root.and_then(|root| root.globals.iter().find(|(stage, _)| *stage == shader.stage));
            let Some((_, id)) = global else { continue };
            if !shader.global(*id).used {
                continue;
            }
            inputs.all.push(Input {
                name: leaf.name.clone(),
                global: *id,
                scalar: shape.scalar,
                columns: shape.columns as usize,
                rows: shape.rows as usize,
                elements: shape.elements as usize,
                stated: stated(shader.global(*id), &leaf.name),
                kind: InputKind::Uniform(number),
            });
        }
        inputs
    }

    /// Whether anything is stated.
    pub(super) fn any_stated(&self) -> bool {
        self.all.iter().any(|input| input.stated.is_some())
    }

    /// The values in a row, as `name = value`, of inputs that `wanted` takes.
    pub(super) fn named(&self, row: &[f32], wanted: impl Fn(GlobalId) -> bool) -> Vec<String> {
        let mut rest = row;
        let mut named = Vec::new();
        for input in &self.all {
            let (own, more) = rest.split_at(input.size().min(rest.len()));
            rest = more;
            if wanted(input.global) {
                named.push(format!("`{}` = {}", input.name, written(input, own)));
            }
        }
        named
    }
}

/// A value as GLSL writes it.
fn written(input: &Input, numbers: &[f32]) -> String {
    let one = |number: &f32| match input.scalar {
        Scalar::Bool => (*number != 0.0).to_string(),
        Scalar::Int | Scalar::Uint => format!("{number:.0}"),
        Scalar::Float => format!("{number:?}"),
    };
    let all: Vec<String> = numbers.iter().map(one).collect();
    if all.len() == 1 { all.concat() } else { format!("({})", all.join(", ")) }
}

/// The range that a comment at the declaration states: `// glisten: range(0, 1)`.
fn in_comment(sources: &SourceMap, global: &Global) -> Option<Bounds> {
    let comment = behind(sources, global.span)?;
    let told = comment.trim_start_matches('/').trim_start().strip_prefix("glisten:")?.trim_start();
    let (range, _) = told.strip_prefix("range")?.trim_start().strip_prefix('(')?.split_once(')')?;
    Bounds::parse(range)
}

fn shape(types: &Types, global: &Global) -> Option<(Scalar, usize, usize)> {
    match types.get(global.ty) {
        Type::Scalar(scalar) if scalar != Scalar::Bool => Some((scalar, 1, 1)),
        Type::Vector(scalar, size) if scalar != Scalar::Bool => Some((scalar, 1, usize::from(size))),
        Type::Matrix(columns, rows) => Some((Scalar::Float, usize::from(columns), usize::from(rows))),
        _ => None,
    }
}

/// The type of a varying with its qualifiers, as the stage before writes it.
fn declaration(types: &Types, global: &Global, stage: Stage) -> String {
    let ty = types.name(global.ty);
    if stage == Stage::Vertex {
        return ty;
    }
    let interpolation = match global.interpolation {
        Interpolation::Flat => "flat ",
        Interpolation::Noperspective => "noperspective ",
        Interpolation::Smooth => "",
    };
    format!("{interpolation}|{ty}")
}
