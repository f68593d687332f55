//! A vertex shader for a fragment shader that comes alone: a triangle that covers the window.
//!
//! *In:* a fragment shader. *Out:* the text of a vertex shader that writes what it reads. *Holds:* a `vec2` goes from (0, 0) at the
//! lower left to (1, 1) at the upper right; longer vectors are filled with 0 and 1, a `float` goes from left to right, and
//! integers are 0. By their names, a normal is that of a bulge, and directions and places are in front of it; a square matrix is the
//! identity.

use super::exit::{Exit, Failure};
use glisten_front::hir::{Interpolation, Scalar, Shader, Storage, Type, Types};
use std::fmt::Write;

/// The attribute for the corners of the triangle, where there is no `gl_VertexID` (ES 1.00).
pub(super) const CORNER: &str = "corner";

/// The `#version` line of the vertex shader: both stages are of OpenGL or both are of OpenGL ES.
fn version_line(fragment: &Shader) -> &'static str {
    match (fragment.version.is_es(), fragment.version.number) {
        (false, _) => "#version 150",
        (true, 300..) => "#version 300 es",
        (true, _) => "#version 100",
    }
}

/// Words of names, with the extent along x and y, and z, of a vector that is no coordinate of the window.
static BULGES: &[(&[&str], [f64; 2])] = &[
    (&["normal", "nrm"], [1.6, 0.8]),
    (&["light", "half"], [0.6, 1.0]),
    (&["eye", "view", "dir", "camera"], [-0.4, 1.0]),
    (&["pos", "world", "point", "vertex"], [2.0, 0.0]),
];

/// The extent and z of a vector, if its name says that it is a normal, a direction or a place.
fn bulge(name: &str) -> Option<[f64; 2]> {
    let name = name.to_ascii_lowercase();
    let is_named = |words: &&[&str]| words.iter().any(|word| name.contains(word));
    let is_coordinate = ["tex", "uv", "coord", "col"].iter().any(|word| name.contains(word));
    BULGES.iter().find(|(words, _)| is_named(words) && !is_coordinate).map(|(_, bulge)| *bulge)
}

/// The text of the vertex shader.
///
/// # Errors
/// The fragment shader reads something that a full-screen triangle has no values for.
pub(super) fn vertex_shader(types: &Types, fragment: &Shader) -> Result<String, Failure> {
    let version = version_line(fragment);
    let is_oldest_es = version == "#version 100";
    let out = if is_oldest_es { "varying" } else { "out" };
    let mut outputs = String::new();
    let mut writes = String::new();
    // The names of the vertex shader's own variables: those of outputs would be hidden by them.
    let is_taken = |name: &str| fragment.globals.iter().any(|global| global.name == name);
    let free = |name: &str| if is_taken(name) { format!("{name}_of_window") } else { name.to_owned() };
    let (uv, corner) = (free("uv"), free(CORNER));
    let inputs = fragment.globals.iter().filter(|global| global.storage == Storage::In && global.builtin.is_none());
    for global in inputs {
        let value = match types.get(global.ty) {
            Type::Scalar(Scalar::Float) => format!("{uv}.x"),
            Type::Vector(Scalar::Float, 2) => uv.clone(),
            Type::Vector(Scalar::Float, size @ 3..=4) if bulge(&global.name).is_some() => {
                let (end, [scale, z]) = (if size == 4 { ", 1.0" } else { "" }, bulge(&global.name).unwrap_or_default());
                format!("vec{size}({scale:?} * {uv} - {:?}, {z:?}{end})", scale / 2.0)
            }
            Type::Matrix(columns, rows) if columns == rows => format!("mat{columns}(1.0)"),
            Type::Vector(Scalar::Float, 3) => format!("vec3({uv}, 0.0)"),
            Type::Vector(Scalar::Float, 4) => format!("vec4({uv}, 0.0, 1.0)"),
            Type::Scalar(Scalar::Int) => "0".to_owned(),
            Type::Scalar(Scalar::Uint) => "0u".to_owned(),
            Type::Vector(Scalar::Int | Scalar::Uint, _) => format!("{}(0)", types.name(global.ty)),
            _ => {
                let ty = types.name(global.ty);
                let message = format!("the input `{} {}` needs a vertex shader that writes it", ty, global.name);
                return Err(
                    Failure::new(Exit::Content, message).help("name the vertex shader before the fragment shader")
                );
            }
        };
        let ty = types.name(global.ty);
        let interpolation = match global.interpolation {
            Interpolation::Flat => "flat ",
            Interpolation::Noperspective => "noperspective ",
            Interpolation::Smooth => "",
        };
        let _ = writeln!(outputs, "{interpolation}{out} {ty} {};", global.name);
        let _ = writeln!(writes, "    {} = {value};", global.name);
    }
    let place = match writes.contains(&uv) {
        true => format!("    vec2 {uv} = 0.5 * {corner} + 0.5;\n"),
        false => String::new(),
    };
    let (how, declared, computed) = if is_oldest_es {
        ("by its corners", format!("attribute vec2 {corner};\n"), String::new())
    } else {
        let value = "vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0)";
        ("without attributes", String::new(), format!("    vec2 {corner} = {value};\n"))
    };
    Ok(format!(
        "{version}\n// A triangle that covers the window: draw 3 vertices, {how}.\n{declared}{outputs}\nvoid main()\n{{\n{computed}{place}\
         {writes}    gl_Position = vec4({corner}, 0.0, 1.0);\n}}\n"
    ))
}
