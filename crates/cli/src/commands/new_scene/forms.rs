//! [`Form`]: the shapes and cameras with which a program may draw, the likeliest one first.
//!
//! *In:* what a program reads. *Out:* forms in the order in which they are tried. *Holds:* a mesh that the user names is the only
//! geometry.

use super::reads::Reads;
use glisten_front::hir::PrimitiveIn;
use std::path::Path;

/// A geometry with a camera.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    /// A mesh: its shape or its file.
    Mesh(Shape, View),
    /// Four vertices with positions in this range, in both directions.
    Square(f64, f64, View),
    /// Four vertices with positions in pixels.
    Pixels,
    /// No data: a number of vertices.
    Count(&'static str, u32),
}

/// A mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Named(String, f64),
    File(String),
}

/// The camera from which matrices follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// A camera that sees a sphere of radius 1.
    Camera,
    /// A camera that sees the square of -1 to 1 in the whole window.
    Front,
    /// The identity.
    Identity,
}

use View::{Camera, Front, Identity};

impl Form {
    /// The form in words.
    pub(super) fn words(&self) -> String {
        let view = |view: &View| match view {
            Camera | Front => "with a camera",
            Identity => "without a camera",
        };
        match self {
            Self::Mesh(Shape::Named(name, _), seen) => format!("a {} {}", name.replace('_', " "), view(seen)),
            Self::Mesh(Shape::File(name), seen) => format!("`{name}` {}", view(seen)),
            Self::Square(low, high, seen) => format!("a square from {low} to {high} {}", view(seen)),
            Self::Pixels => "a square in pixels".to_owned(),
            Self::Count(primitive, count) => {
                format!("{count} vertices without data as {}", primitive.replace('_', " "))
            }
        }
    }
}

/// The mesh that `--mesh` names: a file if there is a dot in it, otherwise a shape.
pub(super) fn shape_of(word: &str) -> Shape {
    match Path::new(word).extension() {
        Some(_) => Shape::File(word.to_owned()),
        None => Shape::Named(word.to_owned(), 1.0),
    }
}

/// The forms for a program, in the order in which they are tried.
pub(super) fn forms(reads: &Reads<'_>, mesh: Option<Shape>, is_flat_engine: bool) -> Vec<Form> {
    if let Some(shape) = mesh {
        return vec![Form::Mesh(shape.clone(), Camera), Form::Mesh(shape, Identity)];
    }
    let Some(size) = reads.position_size() else {
        // Attributes without a position: the other data of a mesh, or data for four vertices.
        let sphere = Form::Mesh(Shape::Named("sphere".to_owned(), 1.0), Camera);
        let others = [Form::Square(-1.0, 1.0, Front), Form::Square(-1.0, 1.0, Identity)];
        let has_mesh = reads.has_texcoords() || reads.has_normals();
        return match reads.inputs.is_empty() {
            true => counts(reads),
            false => has_mesh.then_some(sphere).into_iter().chain(others).collect(),
        };
    };
    let name = if reads.has_normals() && !reads.has_texcoords() { "torus_knot" } else { "sphere" };
    let shape = |radius: f64| Shape::Named(name.to_owned(), radius);
    let (mesh, small) = (Form::Mesh(shape(1.0), Camera), Form::Mesh(shape(0.8), Identity));
    let (square, front) = (Form::Square(-1.0, 1.0, Identity), Form::Square(-1.0, 1.0, Front));
    let (unit, half) = (Form::Square(0.0, 1.0, Identity), Form::Square(-0.5, 0.5, Camera));
    let is_colored = reads.has_colors() && !reads.has_normals();
    let mut forms = match (reads.has_matrices(), size) {
        _ if is_flat_engine && !reads.has_normals() => vec![square, Form::Pixels, front, unit, mesh],
        (true, 0..=2) => vec![front, square, Form::Pixels, unit, mesh],
        (true, _) if is_colored => vec![front, mesh, square, Form::Pixels, small, unit],
        (true, _) => vec![mesh, front, square, small, Form::Pixels, half, unit],
        (false, 0..=2) => vec![square, unit, Form::Pixels, small],
        (false, _) if reads.has_normals() => vec![small, square, unit, Form::Pixels],
        (false, _) => vec![square, small, unit, Form::Pixels],
    };
    if reads.geometry == Some(PrimitiveIn::Points) || reads.geometry == Some(PrimitiveIn::Lines) {
        forms.push(Form::Square(-0.5, 0.5, Identity));
        forms.sort_by_key(|form| !matches!(form, Form::Mesh(..)));
    }
    forms
}

/// The numbers of vertices for a program without data.
fn counts(reads: &Reads<'_>) -> Vec<Form> {
    let several: &[(&str, u32)] = match reads.geometry {
        Some(PrimitiveIn::Points) => &[("points", 1), ("points", 64), ("points", 1024)],
        Some(PrimitiveIn::Lines) => &[("lines", 2), ("lines", 64)],
        Some(PrimitiveIn::LinesAdjacency) => &[("lines_adjacency", 4)],
        Some(PrimitiveIn::TrianglesAdjacency) => &[("triangles_adjacency", 6)],
        _ => &[
            ("triangles", 3),
            ("triangle_strip", 4),
            ("triangles", 6),
            ("triangles", 36),
            ("triangle_fan", 32),
            ("line_strip", 100),
            ("points", 1000),
        ],
    };
    several.iter().map(|(primitive, count)| Form::Count(primitive, *count)).collect()
}
