//! Reflection, held against the rules of the language and against what naga finds in the emitted WGSL.
//!
//! *In:* a program that has been drawn. *Out:* a sentence where an offset, a stride, a binding or a location is another one. *Holds:* offsets are
//! computed here once more from the types alone (OpenGL 3.2 §2.11.4), so that a wrong layout on which all of glisten agrees shows.

use super::drawn::{Drawn, Emission, Read};
use super::targets::wgsl_stages;
use glisten_emit::{Conventions, Reflection, reflect, reflection};
use glisten_front::Stage;
use naga::{Binding, Handle, Module, TypeInner};

type Held = Result<(), String>;

/// Everything that a host reads.
pub(super) fn check(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let told = reflect(&draw.program, &Conventions::default());
    blocks(&told)?;
    // No target has a geometry stage, so that nothing reads what its inputs are.
    if draw.program.stage(Stage::Geometry).is_some() {
        drawn.leave_out("what naga finds, since no target has a geometry stage");
        return Ok(());
    }
    for Emission { stage, read, .. } in wgsl_stages(drawn)? {
        let Some(read) = read else { continue };
        resources(&told, read)?;
        inputs(&told, (*stage, read))?;
        outputs(&told, (*stage, read))?;
    }
    Ok(())
}

/// Scalars in a column, columns, and the bytes of a scalar's vector of so many (OpenGL 3.2 §2.11.4, rules 1 to 8).
fn shape(ty: &str) -> Option<(u32, u32)> {
    let digit = |index: usize| ty.as_bytes().get(index).map(|digit| u32::from(digit - b'0'));
    Some(match ty {
        "float" | "int" | "uint" | "bool" => (1, 1),
        _ if ty.starts_with("mat") => {
            let columns = digit(3)?;
            (if ty.len() > 4 { digit(5)? } else { columns }, columns)
        }
        _ => (u32::from(ty.as_bytes().last()? - b'0'), 1),
    })
}

/// The alignment of a vector.
fn align_of(components: u32) -> u32 {
    match components {
        1 => 4,
        2 => 8,
        _ => 16,
    }
}

/// Offsets, strides and sizes of the members of blocks.
fn blocks(told: &Reflection) -> Held {
    for block in &told.blocks {
        let own = |leaf: &&reflection::Uniform| {
            leaf.block.as_ref() == Some(&block.name) && (leaf.group, leaf.binding) == (block.group, block.binding)
        };
        let (mut end, mut prefix) = (0_u32, None);
        for leaf in told.uniforms.iter().filter(own) {
            let Some((rows, columns)) = shape(&leaf.ty) else { return Ok(()) };
            let is_matrix = leaf.ty.starts_with("mat");
            let (vector, count) = if leaf.row_major { (columns, rows) } else { (rows, columns) };
            let is_array = leaf.array_size.is_some();
            let (mut align, mut size) = (align_of(vector), vector * 4);
            if is_matrix || is_array {
                align = 16;
            }
            if is_matrix {
                size = 16 * count;
            }
            if let Some(elements) = leaf.array_size {
                let stride = size.next_multiple_of(16);
                size = stride * elements;
                wanted(&leaf.name, "array stride", leaf.array_stride, Some(stride))?;
            }
            if is_matrix {
                wanted(&leaf.name, "matrix stride", leaf.matrix_stride, Some(16))?;
            }
            // Structs, and elements of arrays of them, begin and end at multiples of 16.
            let own_prefix = leaf.name.rsplit_once('.').map(|(prefix, _)| prefix);
            if prefix.is_some_and(|prefix| prefix != own_prefix) {
                align = 16;
            }
            prefix = Some(own_prefix);
            let offset = end.next_multiple_of(align);
            wanted(&leaf.name, "offset", Some(leaf.offset), Some(offset))?;
            end = offset + size;
        }
        if end > 0 {
            wanted(&block.name, "size", Some(block.size), Some(end.next_multiple_of(16)))?;
        }
    }
    Ok(())
}

fn wanted<T: PartialEq + std::fmt::Debug>(name: &str, what: &str, is: T, should: T) -> Held {
    if is == should { Ok(()) } else { Err(format!("the {what} of `{name}` is {is:?}, should be {should:?}")) }
}

/// Each variable with a binding is one that the reflection has, and members of buffers are where it says.
fn resources(told: &Reflection, read: &Read) -> Held {
    for (_, global) in read.module.global_variables.iter() {
        let Some(place) = &global.binding else { continue };
        let name = global.name.clone().unwrap_or_default();
        let slot = reflection::Binding { group: place.group, binding: place.binding };
        let mut textures = told.samplers.iter();
        if textures.any(|one| slot == one.texture || slot == one.sampler) {
            continue;
        }
        let is_loose =
            told.loose_block.as_ref().is_some_and(|one| (one.group, one.binding) == (slot.group, slot.binding));
        let in_block = told.blocks.iter().find(|one| {
            let elements = one.array_size.unwrap_or(1);
            one.group == slot.group && (one.binding..one.binding + elements).contains(&slot.binding)
        });
        let size = match (is_loose, in_block) {
            (true, _) => told.loose_block.as_ref().map_or(0, |one| one.size),
            (false, Some(block)) => block.size,
            (false, None) => return Err(format!("`{name}` has a binding that is not reflected: {slot:?}")),
        };
        let span = read.module.types[global.ty].inner.size(read.module.to_ctx());
        if span > size {
            return Err(format!("`{name}` has {span} bytes, its buffer is reflected with {size}"));
        }
        for leaf in told.uniforms.iter().filter(|leaf| (leaf.group, leaf.binding) == (slot.group, slot.binding)) {
            let prefix = leaf.block.as_ref().map(|block| format!("{block}."));
            let path = prefix.and_then(|prefix| leaf.name.strip_prefix(prefix.as_str())).unwrap_or(&leaf.name);
            if let Some(offset) = offset_of(&read.module, global.ty, path) {
                wanted(&leaf.name, "offset in WGSL", leaf.offset, offset)?;
            }
        }
    }
    Ok(())
}

/// The offset of a member by its path: `us.m0`, `a[1].b`; none if the code names it otherwise.
fn offset_of(module: &Module, ty: Handle<naga::Type>, path: &str) -> Option<u32> {
    let TypeInner::Struct { members, .. } = &module.types[ty].inner else { return None };
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let (name, index) = match first.split_once('[') {
        Some((name, index)) => (name, Some(index.trim_end_matches(']').parse::<u32>().ok()?)),
        None => (first, None),
    };
    let member = members.iter().find(|member| member.name.as_deref() == Some(name))?;
    let (mut offset, mut inner) = (member.offset, member.ty);
    if let Some(index) = index {
        let TypeInner::Array { base, stride, .. } = module.types[inner].inner else { return None };
        (offset, inner) = (offset + stride * index, base);
    }
    rest.map_or(Some(offset), |rest| Some(offset + offset_of(module, inner, rest)?))
}

/// The locations of an argument, or of a result, with their numbers of components.
fn locations(module: &Module, ty: Handle<naga::Type>, binding: Option<&Binding>, found: &mut Vec<(u32, u32)>) {
    match (binding, &module.types[ty].inner) {
        (Some(Binding::Location { location, .. }), TypeInner::Scalar(_)) => found.push((*location, 1)),
        (Some(Binding::Location { location, .. }), TypeInner::Vector { size, .. }) => {
            found.push((*location, *size as u32));
        }
        (_, TypeInner::Struct { members, .. }) => {
            members.iter().for_each(|member| locations(module, member.ty, member.binding.as_ref(), found));
        }
        _ => {}
    }
}

fn inputs(told: &Reflection, (stage, read): (Stage, &Read)) -> Held {
    let Some(entry) = read.module.entry_points.first() else { return Ok(()) };
    let mut found = Vec::new();
    for argument in &entry.function.arguments {
        locations(&read.module, argument.ty, argument.binding.as_ref(), &mut found);
    }
    for (location, components) in found {
        let is_told = match stage {
            Stage::Vertex => told.attributes.iter().any(|one| {
                let rows = shape(&one.ty).map_or(0, |(rows, _)| rows);
                (one.location..one.location + one.columns).contains(&location) && rows == components
            }),
            _ => varying(told, location, components),
        };
        if !is_told {
            return Err(format!("{:?}: an input of {components} at location {location} is not reflected", stage));
        }
    }
    Ok(())
}

/// Whether varyings fill so many components of a location.
fn varying(told: &Reflection, location: u32, components: u32) -> bool {
    let here = told.varyings.iter().filter(|one| one.location == location);
    let end = here.map(|one| one.component + shape(&one.ty).map_or(0, |(rows, _)| rows)).max();
    end == Some(components)
}

fn outputs(told: &Reflection, (stage, read): (Stage, &Read)) -> Held {
    let result = read.module.entry_points.first().and_then(|entry| entry.function.result.as_ref());
    let Some(result) = result else { return Ok(()) };
    let mut found = Vec::new();
    locations(&read.module, result.ty, result.binding.as_ref(), &mut found);
    for (location, components) in found {
        let is_told = match stage {
            Stage::Vertex => varying(told, location, components),
            // An array takes a location for each element.
            _ => told
                .outputs
                .iter()
                .any(|one| one.location == location || one.ty.contains('[') && one.location <= location),
        };
        if !is_told {
            return Err(format!("{:?}: an output of {components} at location {location} is not reflected", stage));
        }
    }
    Ok(())
}
