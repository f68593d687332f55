//! A fragment shader for a vertex shader that comes alone: it shows the varyings.
//!
//! *In:* a vertex shader. *Out:* the text of a fragment shader that reads what it writes. *Holds:* every number that is not infinite gives
//! a color between black and white; varyings go to red, green and blue in turn. Blocks and structs are left out.

use crate::fullscreen::{qualifiers, version_line};
use glisten_front::hir::{ArraySize, Global, Scalar, Shader, Storage, Type, TypeId, Types};
use std::fmt::Write;

/// A name that no varying has.
const SUM: &str = "sum_of_varyings";

/// The text of the fragment shader.
pub(crate) fn fragment_shader(types: &Types, vertex: &Shader) -> String {
    let (is_es, is_old) = (vertex.version.is_es(), vertex.version.is_es() && vertex.version.number < 300);
    let is_varying = |global: &&Global| {
        global.storage == Storage::Out && global.builtin.is_none() && global.block.is_none() && !global.is_fixed()
    };
    let precisions = match (is_es, is_old) {
        (false, _) => "",
        (true, false) => "precision highp float;\nprecision highp int;\n",
        (true, true) => "precision highp float;\n",
    };
    let mut text = format!("{}\n{precisions}", version_line(vertex, false, vertex.globals.iter().filter(is_varying)));
    let mut sums = String::new();
    let varyings =
        vertex.globals.iter().filter(is_varying).filter_map(|one| Some((one, number(types, &one.name, one.ty)?)));
    for (index, (global, number)) in varyings.enumerate() {
        let (ty, sizes) = declared(types, global.ty);
        let word = if is_old { "varying" } else { "in" };
        let _ = writeln!(text, "{}{word} {ty} {}{sizes};", qualifiers(global), global.name);
        let channel = ["r", "g", "b"].get(index % 3).unwrap_or(&"r");
        let _ = writeln!(sums, "    {SUM}.{channel} += {number};");
    }
    let color = if is_old { "gl_FragColor" } else { "color_of_varyings" };
    if !is_old {
        let _ = writeln!(text, "out vec4 {color};");
    }
    let _ = write!(
        text,
        "\nvoid main() {{\n    vec3 {SUM} = vec3(0.5);\n{sums}    {color} = vec4(0.5 + 0.5 * {SUM} / (1.0 + abs({SUM})), 1.0);\n}}\n"
    );
    text
}

/// The name of a type without its arrays, and their sizes.
fn declared(types: &Types, ty: TypeId) -> (String, String) {
    match types.get(ty) {
        Type::Array(element, ArraySize::Sized(size)) => {
            let (name, sizes) = declared(types, element);
            (name, format!("[{size}]{sizes}"))
        }
        _ => (types.name(ty), String::new()),
    }
}

/// A number that depends on all components of a varying, or on the first element of an array.
fn number(types: &Types, name: &str, ty: TypeId) -> Option<String> {
    const WEIGHTS: [&str; 4] = ["1.0", "0.7", "0.4", "0.2"];
    let weighted = |vector: &str, size: u8| {
        let weights = WEIGHTS.iter().take(usize::from(size)).copied().collect::<Vec<_>>().join(", ");
        format!("dot({vector}, vec{size}({weights}))")
    };
    Some(match types.get(ty) {
        Type::Scalar(Scalar::Float) => name.to_owned(),
        Type::Scalar(Scalar::Int | Scalar::Uint) => format!("float({name})"),
        Type::Vector(Scalar::Float, size) => weighted(name, size),
        Type::Vector(Scalar::Int | Scalar::Uint, size) => weighted(&format!("vec{size}({name})"), size),
        Type::Matrix(columns, rows) => {
            let all: Vec<String> = (0..columns).map(|column| weighted(&format!("{name}[{column}]"), rows)).collect();
            all.join(" + ")
        }
        Type::Array(element, ArraySize::Sized(_)) => number(types, &format!("{name}[0]"), element)?,
        _ => return None,
    })
}
