//! Writes the reflection as tables for people.

use super::{Reflection, StructArray, StructMember};

/// Writes one table for each kind, with a heading, left-aligned columns and no colors. Kinds that the program lacks
/// are omitted.
pub fn table(reflection: &Reflection) -> String {
    let mut text = String::new();
    let mut section = |title: &str, heads: &[&str], rows: Vec<Vec<String>>| {
        if !rows.is_empty() {
            text.push_str(&format!("{title}\n{}\n", left_aligned(heads, &rows)));
        }
    };
    let yes = |active: bool| if active { "yes" } else { "no" }.to_owned();
    let option = |value: Option<u32>| value.map_or("-".to_owned(), |value| value.to_string());
    let array = |ty: &str, size: Option<u32>| size.map_or(ty.to_owned(), |size| format!("{ty}[{size}]"));
    let place = |group: u32, binding: u32| format!("{group}.{binding}");

    let rows = reflection.attributes.iter().map(|row| {
        vec![row.name.clone(), row.ty.clone(), row.location.to_string(), row.columns.to_string(), yes(row.active)]
    });
    section("attributes", &["name", "type", "location", "columns", "active"], rows.collect());

    let rows = reflection.varyings.iter().map(|row| {
        let sampling = match (row.centroid, row.sample) {
            (true, _) => " centroid",
            (_, true) => " sample",
            _ => "",
        };
        let interpolation = format!("{}{sampling}", row.interpolation);
        let location = format!("{}.{}", row.location, row.component);
        vec![row.name.clone(), row.ty.clone(), location, interpolation, yes(row.active)]
    });
    section("varyings", &["name", "type", "location", "interpolation", "active"], rows.collect());

    let rows = reflection
        .outputs
        .iter()
        .map(|row| vec![row.name.clone(), row.ty.clone(), row.location.to_string(), row.index.to_string()]);
    section("outputs", &["name", "type", "color", "index"], rows.collect());

    let loose = reflection.loose_block.iter().map(|row| {
        let (place, stages) = (place(row.group, row.binding), row.visibility.join(" "));
        vec!["(loose uniforms)".into(), "-".into(), place, row.size.to_string(), stages, "-".into()]
    });
    let rows = reflection.blocks.iter().map(|row| {
        let name = array(&row.name, row.array_size);
        let instance = row.instance.clone().unwrap_or_else(|| "-".into());
        let (place, stages) = (place(row.group, row.binding), row.visibility.join(" "));
        vec![name, instance, place, row.size.to_string(), stages, yes(row.active)]
    });
    section("blocks", &["name", "instance", "binding", "bytes", "stages", "active"], loose.chain(rows).collect());

    let rows = reflection.uniforms.iter().map(|row| {
        let default = row
            .default
            .as_ref()
            .map_or("-".to_owned(), |values| values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "));
        let order = if row.row_major { "row_major" } else { "" };
        let strides = [row.array_stride, row.matrix_stride].map(option).join(" ");
        let ty = [array(&row.ty, row.array_size).as_str(), order].join(" ").trim_end().to_owned();
        let place = place(row.group, row.binding);
        vec![row.name.clone(), ty, place, row.offset.to_string(), strides, default, yes(row.active)]
    });
    let heads = ["name", "type", "binding", "offset", "strides", "default", "active"];
    let once = reflection.struct_arrays.iter().filter(|array| array.is_compact(reflection));
    section("uniforms", &heads, rows.chain(once.flat_map(struct_rows)).collect());

    let rows = reflection.samplers.iter().map(|row| {
        let texture = place(row.texture.group, row.texture.binding);
        let sampler =
            if row.sampler == row.texture { "-".into() } else { place(row.sampler.group, row.sampler.binding) };
        vec![row.name.clone(), row.ty.clone(), texture, sampler, row.visibility.join(" "), yes(row.active)]
    });
    section("samplers", &["name", "type", "texture", "sampler", "stages", "active"], rows.collect());
    text.push_str(&conventions(reflection));
    text
}

/// The rows of an array of structs: one for the array, and one for each member of an element, with its offset in it.
fn struct_rows(array: &StructArray) -> Vec<Vec<String>> {
    let active = if array.active { "yes" } else { "no" };
    let cells = |name: String, ty: String, offset: u32, strides: [Option<u32>; 2]| {
        let strides = strides.map(|stride| stride.map_or("-".to_owned(), |stride| stride.to_string())).join(" ");
        let place = format!("{}.{}", array.group, array.binding);
        vec![name, ty, place, offset.to_string(), strides, "-".to_owned(), active.to_owned()]
    };
    let ty = format!("{}[{}]", array.ty, array.array_size);
    let mut rows = vec![cells(array.name.clone(), ty, array.offset, [Some(array.array_stride), None])];
    let mut pending: Vec<(String, &StructMember)> =
        array.members.iter().rev().map(|member| (format!("{}[].{}", array.name, member.name), member)).collect();
    while let Some((path, member)) = pending.pop() {
        let ty = member.array_size.map_or(member.ty.clone(), |size| format!("{}[{size}]", member.ty));
        rows.push(cells(path.clone(), ty, member.offset, [member.array_stride, member.matrix_stride]));
        let inner = member.members.iter().rev();
        pending.extend(inner.map(|inner| (format!("{path}[].{}", inner.name), inner)));
    }
    rows
}

fn conventions(reflection: &Reflection) -> String {
    let row = &reflection.conventions;
    let height = row
        .framebuffer_height
        .map_or("-".to_owned(), |slot| format!("{}.{} offset {}", slot.group, slot.binding, slot.offset));
    let rows = [
        ("clip_z", row.clip_z.clone()),
        ("window_origin", row.window_origin.clone()),
        ("front_face", row.front_face.clone()),
        ("framebuffer_height", height),
        ("provoking_vertex", row.provoking_vertex.clone()),
        ("spirv_env", row.spirv_env.clone()),
        ("clip_distances", row.clip_distances.to_string()),
        ("point_size", row.point_size.to_string()),
    ];
    let sprites = row.point_sprites.as_ref().map(|row| {
        let place = format!("{}.{}", row.group, row.binding);
        ("point_sprites", format!("{} of {} vertices, viewport size at {place}", row.topology, row.vertices))
    });
    let lines: String = rows.iter().chain(&sprites).map(|(name, value)| format!("  {name:<20}{value}\n")).collect();
    format!("conventions\n{lines}")
}

/// A table of words: a row of heads, and every column aligned to the left.
fn left_aligned(heads: &[&str], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain(heads.get(column).map(|head| head.len())).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let padded: String = cells.zip(&widths).map(|(cell, width)| format!("  {cell:<width$}")).collect();
        format!("{}\n", padded.trim_end())
    };
    let mut text = line(&mut heads.iter().copied());
    for row in rows {
        text.push_str(&line(&mut row.iter().map(String::as_str)));
    }
    text
}
