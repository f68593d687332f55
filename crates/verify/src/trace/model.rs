//! [`Told`]: a trace with places in the text, as the JSON of `glisten trace` has it.

use super::numbers::Number;
use glisten_front::hir::Types;
use glisten_front::source::{SourceMap, Span};
use glisten_reference::trace::{Component, Entry, Fate, Invocation, Invoked, NoteKind, Place, Trace};
use glisten_scene::Scene;
use serde::Serialize;

/// The result for a place of a scene.
#[derive(Debug, Serialize)]
pub struct Told {
    pub(super) scene: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) pixel: Option<[u32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) vertex: Option<u32>,
    pub(super) invocations: Vec<ToldInvocation>,
    /// The color of the pixel in each attachment.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) colors: Vec<ToldValue>,
}

#[derive(Debug, Serialize)]
pub(super) struct ToldInvocation {
    pub(super) stage: &'static str,
    pub(super) draw: usize,
    pub(super) instance: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) primitive: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) front_facing: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) vertex: Option<u32>,
    /// The vertices of the primitive.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) vertices: Vec<u32>,
    pub(super) fate: &'static str,
    pub(super) steps: Vec<ToldStep>,
    /// The number of steps that were too many to be kept.
    pub(super) left_out: usize,
}

#[derive(Debug, Serialize)]
pub(super) struct ToldStep {
    pub(super) kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    pub(super) place: Option<ToldPlace>,
    /// The text; of a variable, its name.
    pub(super) text: String,
    #[serde(rename = "type", skip_serializing_if = "String::is_empty")]
    pub(super) ty: String,
    /// The number of calls around it.
    pub(super) depth: usize,
    #[serde(flatten)]
    pub(super) value: ToldValue,
}

/// Where a text is: lines and columns from 1, columns in characters; half-open.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct ToldPlace {
    pub(super) file: String,
    pub(super) start: Position,
    pub(super) end: Position,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(super) struct Position {
    pub(super) line: u32,
    pub(super) column: u32,
}

/// A value in flat order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ToldValue {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) value: Vec<Scalar>,
    /// In exact arithmetic; empty of integers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) exact: Vec<Number>,
    /// The values of a conforming GPU; empty if it may have gone another way.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) interval: Vec<[Number; 2]>,
    /// Whether a conforming GPU may have a NaN.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) may_be_nan: bool,
    /// Whether f32 is far from exact arithmetic.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) is_far: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Scalar {
    Float(Number),
    Int(i64),
    Bool(bool),
}

/// A trace at its places.
pub fn told(name: &str, scene: &Scene, sources: &SourceMap, place: Place, trace: &Trace) -> Told {
    let (pixel, vertex) = match place {
        Place::Pixel(pixel) => (Some(pixel), None),
        Place::Vertex { vertex, .. } => (None, Some(vertex)),
    };
    let invocations = trace.invocations.iter().map(|one| invocation(one, scene, sources)).collect();
    let colors = trace.colors.iter().map(|color| value(color)).collect();
    Told { scene: name.to_owned(), pixel, vertex, invocations, colors }
}

fn invocation(one: &Invocation, scene: &Scene, sources: &SourceMap) -> ToldInvocation {
    let (vertex, primitive, front_facing) = match one.invoked {
        Invoked::Vertex { vertex, .. } => (Some(vertex), None, None),
        Invoked::Fragment { primitive, front } => (None, Some(primitive), Some(front)),
    };
    let types = scene.draws.get(one.draw).map(|draw| &draw.program.types);
    ToldInvocation {
        stage: one.stage.name(),
        draw: one.draw,
        instance: one.instance,
        primitive,
        front_facing,
        vertex,
        vertices: one.vertices.clone(),
        fate: match (one.fate, vertex) {
            (Fate::Done, Some(_)) => "done",
            (Fate::Done, None) => "drawn",
            (Fate::Discarded, _) => "discarded",
            (Fate::Failed, _) => "failed",
        },
        steps: one.entries.iter().map(|entry| step(entry, types, sources)).collect(),
        left_out: one.left_out,
    }
}

fn step(entry: &Entry, types: Option<&Types>, sources: &SourceMap) -> ToldStep {
    let is_void = entry.scalars.is_empty();
    ToldStep {
        kind: kind(entry.kind),
        place: place(entry.span, sources),
        text: if entry.name.is_empty() { on_one_line(sources.snippet(entry.span)) } else { entry.name.clone() },
        ty: types.filter(|_| !is_void).map(|types| types.name(entry.ty)).unwrap_or_default(),
        depth: entry.depth,
        value: value(&entry.scalars),
    }
}

fn kind(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Input => "input",
        NoteKind::Output => "output",
        NoteKind::Read => "read",
        NoteKind::Value => "value",
        NoteKind::Local => "local",
        NoteKind::Call => "call",
        NoteKind::Return => "return",
        NoteKind::If => "if",
        NoteKind::Loop => "loop",
        NoteKind::Switch => "switch",
        NoteKind::Discard => "discard",
    }
}

/// The place outside of macros.
fn place(span: Span, sources: &SourceMap) -> Option<ToldPlace> {
    let at = sources.location(sources.call_site(span)).filter(|_| span.is_known())?;
    Some(ToldPlace {
        file: sources.file(at.file).name().to_owned(),
        start: Position { line: at.line, column: at.column },
        end: Position { line: at.end_line, column: at.end_column },
    })
}

fn on_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn value(scalars: &[Component]) -> ToldValue {
    let mut told =
        ToldValue { value: Vec::new(), exact: Vec::new(), interval: Vec::new(), may_be_nan: false, is_far: false };
    for scalar in scalars {
        told.value.push(match *scalar {
            Component::Float { single, exact, interval } => {
                told.exact.push(Number(exact));
                told.is_far |= is_far(single, exact);
                if let Some(interval) = interval {
                    told.interval.push([Number(interval.low), Number(interval.high)]);
                    told.may_be_nan |= interval.may_be_nan;
                }
                Scalar::Float(Number(single))
            }
            Component::Int(value) => Scalar::Int(value.into()),
            Component::Uint(value) | Component::Sampler(value) => Scalar::Int(value.into()),
            Component::Bool(value) => Scalar::Bool(value),
        });
    }
    told
}

/// A value in f32 that differs from the exact one by more than this share of it is far from it.
const FAR: f64 = 1e-4;

fn is_far(single: f64, exact: f64) -> bool {
    let is_same = single == exact || single.is_nan() && exact.is_nan();
    let off = (single - exact).abs();
    !is_same && (off.is_nan() || off > FAR * exact.abs())
}
