//! [`header`]: what a host of Vulkan has to set up for a program, as a header of C.
//!
//! *In:* a program of new texts, and its reflection. *Out:* macros for locations, sets and bindings; a struct for each block, whose offsets the
//! compiler of C checks. *Holds:* the header needs nothing but `stddef.h` and `stdint.h`.

use glisten_emit::reflection::{Reflection, Uniform};
use glisten_front::link::Program;
use std::fmt::Write;

/// The header of a program.
pub fn header(name: &str, program: &Program, reflection: &Reflection) -> String {
    let upper = word(name).to_uppercase();
    let mut text = format!("#ifndef {upper}_H\n#define {upper}_H\n\n#include <stddef.h>\n#include <stdint.h>\n\n");
    let mut define = |what: &str, name: &str, value: u32| {
        let _ = writeln!(text, "#define {upper}_{what}_{} {value}u", word(name).to_uppercase());
    };
    reflection.attributes.iter().for_each(|one| define("LOCATION", &one.name, one.location));
    reflection.outputs.iter().for_each(|one| define("OUTPUT", &one.name, one.location));
    // The numbers of the text, which several programs may share.
    for block in &program.interface.blocks {
        define("SET", &block.name, block.slot.group);
        define("BINDING", &block.name, block.unit.unwrap_or(block.slot.binding));
    }
    for sampler in &program.interface.samplers {
        define("SET", &sampler.name, sampler.texture.group);
        define("BINDING", &sampler.name, sampler.unit.unwrap_or(sampler.texture.binding));
    }
    for block in &reflection.blocks {
        // Blocks of several stages may be views of one buffer, of different sizes.
        let own = |one: &&Uniform| {
            (one.group, one.binding) == (block.group, block.binding) && one.offset + bytes(one) <= block.size
        };
        let mut members: Vec<&Uniform> = reflection.uniforms.iter().filter(own).collect();
        members.sort_by_key(|one| one.offset);
        structure(&mut text, &format!("{}_{}", word(name), word(&block.name)), &members, block.size);
    }
    text.push_str("\n#endif\n");
    text
}

/// A name of C.
fn word(name: &str) -> String {
    let mut word = String::new();
    for letter in name.chars() {
        let is_part = letter.is_ascii_alphanumeric();
        if is_part {
            word.push(letter);
        } else if !word.ends_with('_') {
            word.push('_');
        }
    }
    let word = word.trim_matches('_').to_owned();
    if word.starts_with(|first: char| first.is_ascii_digit()) || word.is_empty() { format!("_{word}") } else { word }
}

/// A struct with the bytes between its members.
fn structure(text: &mut String, name: &str, members: &[&Uniform], size: u32) {
    let _ = write!(text, "\ntypedef struct {{\n");
    let (mut at, mut n_gaps) = (0_u32, 0);
    let mut checks = String::new();
    let mut gap = |text: &mut String, from: u32, to: u32| {
        if to > from {
            let _ = writeln!(text, "    uint8_t gap_{n_gaps}[{}];", to - from);
            n_gaps += 1;
        }
    };
    for one in members {
        if one.offset < at {
            continue;
        }
        gap(text, at, one.offset);
        let bytes = bytes(one);
        let field = word(&one.name);
        let scalar = if one.ty.starts_with('i') {
            "int32_t"
        } else if one.ty.starts_with('u') || one.ty.starts_with('b') {
            "uint32_t"
        } else {
            "float"
        };
        let n = bytes / 4;
        let array = if n == 1 { String::new() } else { format!("[{n}]") };
        let _ = writeln!(text, "    {scalar} {field}{array}; // {}", written(one));
        let _ = writeln!(checks, "_Static_assert(offsetof({name}, {field}) == {}, \"{field}\");", one.offset);
        at = one.offset + bytes;
    }
    gap(text, at, size);
    let _ = write!(text, "}} {name};\n\n{checks}_Static_assert(sizeof({name}) == {size}, \"{name}\");\n");
}

fn written(one: &Uniform) -> String {
    one.array_size.map_or_else(|| one.ty.clone(), |size| format!("{}[{size}]", one.ty))
}

/// The bytes that a uniform takes, with what is between columns and elements.
fn bytes(one: &Uniform) -> u32 {
    let digit = |text: &str| text.chars().next().and_then(|first| first.to_digit(10));
    let (columns, rows) = match one.ty.split_once("mat") {
        Some((_, size)) => {
            let columns = digit(size).unwrap_or(4);
            (columns, size.split_once('x').map_or(Some(columns), |(_, rows)| digit(rows)).unwrap_or(columns))
        }
        None => (1, one.ty.chars().last().and_then(|last| last.to_digit(10)).unwrap_or(1)),
    };
    let (vectors, scalars) = if one.row_major { (rows, columns) } else { (columns, rows) };
    let single = one.matrix_stride.map_or(scalars * 4, |stride| stride * vectors);
    one.array_size.zip(one.array_stride).map_or(single, |(size, stride)| size * stride)
}
