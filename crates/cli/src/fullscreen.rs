//! A vertex shader for a fragment shader that comes alone: a triangle that covers the window.
//!
//! *In:* a fragment shader. *Out:* the text of a vertex shader that writes what it reads. *Holds:* a `vec2` goes from (0, 0) at the
//! lower left to (1, 1) at the upper right; longer vectors are filled with 0 and 1, a `float` goes from left to right, and
//! integers are 0. The elements of an array and the members of a block are like variables. By their names, a normal is that of a bulge, and directions and places are in front of it; a square matrix is the
//! identity.

use crate::exit::{Exit, Failure};
use glisten_front::hir::{ArraySize, Global, Interpolation, Sampling, Scalar, Shader, Storage, Type, TypeId, Types};
use std::fmt::Write;

/// The largest array that is written.
const MAX_ELEMENTS: u32 = 32;

/// The attribute for the corners of the triangle, where there is no `gl_VertexID` (ES 1.00).
pub(crate) const CORNER: &str = "corner";

/// The `#version` line of a shader that is written for another one. The stages of a program of OpenGL ES have one version, and those of
/// OpenGL any; varyings with components and blocks with locations need GLSL 4.40, varyings with locations 4.10,
/// and those of samples 4.00.
pub(crate) fn version_line<'g>(
    other: &Shader,
    has_fixed: bool,
    varyings: impl Iterator<Item = &'g Global> + Clone,
) -> String {
    let number = other.version.number;
    if other.version.is_es() {
        return if number < 300 { "#version 100".to_owned() } else { format!("#version {number} es") };
    }
    let is_enhanced =
        |global: &Global| global.component.is_some() || global.location.is_some() && global.block.is_some();
    let least = match () {
        () if varyings.clone().any(is_enhanced) => 440,
        () if varyings.clone().any(|global| global.location.is_some()) => 410,
        () if varyings.clone().any(|global| global.sampling == Sampling::Sample) => 400,
        () => 150,
    };
    format!("#version {least}{}", if has_fixed { " compatibility" } else { "" })
}

/// The qualifiers of a varying before the word of its storage, which both stages have to repeat.
pub(crate) fn qualifiers(global: &Global) -> String {
    let place = match (global.location, global.component) {
        (Some(location), Some(component)) => format!("layout(location = {location}, component = {component}) "),
        (Some(location), None) => format!("layout(location = {location}) "),
        (None, _) => String::new(),
    };
    let invariant = if global.invariant { "invariant " } else { "" };
    let how = interpolation(global.interpolation, global.interpolation_written);
    format!("{place}{invariant}{how}{}", global.sampling.prefix())
}

/// Words of names, with the extent along x and y, and z, of a vector that is no coordinate of the window. Distances are in pixels.
static BULGES: &[(&[&str], [f64; 2])] = &[
    (&["normal", "nrm"], [1.6, 0.8]),
    (&["light", "half"], [0.6, 1.0]),
    (&["eye", "view", "dir", "camera"], [-0.4, 1.0]),
    (&["pos", "world", "point", "vertex"], [2.0, 0.0]),
    (&["dist"], [20.0, 5.0]),
];

/// The extent and z of a vector, if its name says that it is a normal, a direction or a place.
fn bulge(name: &str) -> Option<[f64; 2]> {
    let name = name.to_ascii_lowercase();
    let is_named = |words: &&[&str]| words.iter().any(|word| name.contains(word));
    let is_coordinate = ["tex", "uv", "coord", "col"].iter().any(|word| name.contains(word));
    BULGES.iter().find(|(words, _)| is_named(words) && !is_coordinate).map(|(_, bulge)| *bulge)
}

/// The value of an input of this name and type, with the place in the window in the variable `uv`.
fn value(types: &Types, name: &str, ty: TypeId, uv: &str) -> Option<String> {
    Some(match types.get(ty) {
        Type::Scalar(Scalar::Float) => format!("{uv}.x"),
        Type::Vector(Scalar::Float, 2) => uv.to_owned(),
        Type::Vector(Scalar::Float, size @ 3..=4) if bulge(name).is_some() => {
            let (end, [scale, z]) = (if size == 4 { ", 1.0" } else { "" }, bulge(name).unwrap_or_default());
            format!("vec{size}({scale:?} * {uv} - {:?}, {z:?}{end})", scale / 2.0)
        }
        Type::Matrix(columns, rows) if columns == rows => format!("mat{columns}(1.0)"),
        Type::Vector(Scalar::Float, 3) => format!("vec3({uv}, 0.0)"),
        Type::Vector(Scalar::Float, 4) => format!("vec4({uv}, 0.0, 1.0)"),
        Type::Scalar(Scalar::Int) => "0".to_owned(),
        Type::Scalar(Scalar::Uint) => "0u".to_owned(),
        Type::Vector(Scalar::Int | Scalar::Uint, _) => format!("{}(0)", types.name(ty)),
        Type::Array(element, ArraySize::Sized(size @ 1..=MAX_ELEMENTS)) => {
            let one = value(types, name, element, uv).filter(|_| !matches!(types.get(element), Type::Array(..)))?;
            format!("{}({})", types.name(ty), vec![one; size as usize].join(", "))
        }
        _ => return None,
    })
}

/// The declarations and assignments of the vertex shader for the inputs of a fragment shader.
#[derive(Default)]
struct Outputs {
    declared: String,
    written: String,
}

impl Outputs {
    fn add(&mut self, (types, out, uv): (&Types, &str, &str), global: &Global) -> Result<(), Failure> {
        let name = global.match_name();
        if let Type::Struct(id) = types.get(global.ty)
            && let Some(block) = &global.block
        {
            let place = global.location.map_or_else(String::new, |at| format!("layout(location = {at}) "));
            let _ = writeln!(self.declared, "{place}{out} {} {{", block.name);
            for member in &types.structure(id).members {
                let how = member.interpolation.map_or("", |how| interpolation(how, true));
                let invariant = if member.invariant { "invariant " } else { "" };
                let sampling = member.sampling.prefix();
                let ty = types.name(member.ty);
                let _ = writeln!(self.declared, "    {invariant}{how}{sampling}{ty} {};", member.name);
                let place = block.instance.as_ref().map_or_else(String::new, |instance| format!("{instance}."));
                let value = value(types, &member.name, member.ty, uv).ok_or_else(|| missing(types, global))?;
                let _ = writeln!(self.written, "    {place}{} = {value};", member.name);
            }
            let _ = writeln!(
                self.declared,
                "}}{};",
                block.instance.as_ref().map_or_else(String::new, |name| format!(" {name}"))
            );
            return Ok(());
        }
        match types.get(global.ty) {
            // A fixed array of the pipeline is written element by element.
            Type::Array(element, ArraySize::Sized(size)) if global.is_fixed() => {
                let value = value(types, name, element, uv).ok_or_else(|| missing(types, global))?;
                for index in 0..size.min(MAX_ELEMENTS) {
                    let _ = writeln!(self.written, "    {name}[{index}] = {value};");
                }
            }
            _ => {
                let value = value(types, name, global.ty, uv).ok_or_else(|| missing(types, global))?;
                let _ = writeln!(self.written, "    {name} = {value};");
            }
        }
        if !global.is_fixed() {
            let _ = writeln!(self.declared, "{}{out} {} {name};", qualifiers(global), types.name(global.ty));
        }
        Ok(())
    }
}

fn interpolation(interpolation: Interpolation, is_written: bool) -> &'static str {
    match interpolation {
        Interpolation::Flat => "flat ",
        Interpolation::Noperspective => "noperspective ",
        Interpolation::Smooth if is_written => "smooth ",
        Interpolation::Smooth => "",
    }
}

fn missing(types: &Types, global: &Global) -> Failure {
    let message = format!("the input `{} {}` needs a vertex shader that writes it", types.name(global.ty), global.name);
    Failure::new(Exit::Content, message).help("name the vertex shader before the fragment shader")
}

/// The text of the vertex shader.
///
/// # Errors
/// The fragment shader reads something that a full-screen triangle has no values for.
pub(crate) fn vertex_shader(types: &Types, fragment: &Shader) -> Result<String, Failure> {
    let is_input = |global: &&Global| global.storage == Storage::In && global.builtin.is_none();
    let has_fixed = fragment.globals.iter().filter(is_input).any(Global::is_fixed);
    let version = version_line(fragment, has_fixed, fragment.globals.iter().filter(is_input));
    let is_oldest_es = version == "#version 100";
    let out = if is_oldest_es { "varying" } else { "out" };
    // The names of the vertex shader's own variables: those of outputs would be hidden by them.
    let is_taken = |name: &str| fragment.globals.iter().any(|global| global.name == name);
    let free = |name: &str| if is_taken(name) { format!("{name}_of_window") } else { name.to_owned() };
    let (uv, corner) = (free("uv"), free(CORNER));
    let mut outputs = Outputs::default();
    for global in fragment.globals.iter().filter(is_input) {
        outputs.add((types, out, &uv), global)?;
    }
    let Outputs { declared: outputs, written: writes } = outputs;
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
