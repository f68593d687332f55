//! [`expand`]: scenes without geometry stages, for targets that have none.
//!
//! *In:* a [`Scene`]. *Out:* the same scene, in which each draw with a geometry stage is replaced by what that stage emits:
//! the reference runs the vertex and the geometry stage in f32, and a vertex stage passes the numbers on. *Holds:* the
//! fragment stage is the original one. Its uniforms and textures keep their values; bindings may change.

use crate::pass_through::{Attribute, Source, pass_through};
use crate::pipeline::Emission;
use crate::{RenderOptions, pipeline};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{Scalar, Stage};
use glisten_scene::{AttributeData, AttributeValues, Draw, Framebuffer, Scene, State};
use std::borrow::Cow;
use std::sync::Arc;

/// Whether a draw of the scene has a geometry stage.
pub fn has_geometry_stage(scene: &Scene) -> bool {
    scene.draws.iter().any(|draw| draw.program.stage(Stage::Geometry).is_some())
}

/// Replaces geometry stages by what they emit. A scene without any comes back as it is.
///
/// # Errors
/// Those of [`render`](crate::render), or more numbers for each vertex than a target takes.
pub fn expand(scene: &Scene) -> Result<Cow<'_, Scene>, Vec<Diagnostic>> {
    if !has_geometry_stage(scene) {
        return Ok(Cow::Borrowed(scene));
    }
    let mut draws = Vec::with_capacity(scene.draws.len());
    for draw in &scene.draws {
        let has_stage = draw.program.stage(Stage::Geometry).is_some();
        draws.push(if has_stage { expand_draw(draw, scene.framebuffer)? } else { draw.clone() });
    }
    Ok(Cow::Owned(Scene { draws, ..scene.clone() }))
}

fn expand_draw(draw: &Draw, framebuffer: Framebuffer) -> Result<Draw, Vec<Diagnostic>> {
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    let emission = pipeline::expand(draw, framebuffer, &options)?;
    let (program, attributes) = pass_through(&draw.program, emission.distances.0 as u32)?;
    let mut data = Vec::with_capacity(attributes.len());
    for attribute in &program.interface.attributes {
        let made = attributes.iter().find(|made| made.name == attribute.name);
        data.push(made.map(|made| data_of(made, &emission)));
    }
    let value_of = |name: &str| draw.program.interface.roots.iter().position(|root| root.name == name);
    let uniforms = program.interface.roots.iter().map(|root| {
        let known = value_of(&root.name).and_then(|index| draw.uniforms.get(index));
        known.cloned().unwrap_or_default()
    });
    let slot_of = |name: &str| draw.program.interface.samplers.iter().position(|slot| slot.name == name);
    let textures = program.interface.samplers.iter().map(|slot| {
        let known = slot_of(&slot.name).and_then(|index| draw.textures.get(index));
        known.cloned().flatten()
    });
    Ok(Draw {
        state: State { primitive: emission.primitive, ..draw.state },
        vertex_count: emission.indices.len() as u32,
        instances: u32::from(!emission.indices.is_empty()),
        attributes: data,
        uniforms: uniforms.collect(),
        textures: textures.collect(),
        dynamic: draw.dynamic.clone(),
        fixed: draw.fixed.clone(),
        indices: Some(emission.indices),
        program: Arc::new(program),
    })
}

/// The numbers of an attribute, one row for each emitted vertex.
fn data_of(attribute: &Attribute, emission: &Emission) -> AttributeData {
    let count = emission.positions.len();
    let size = attribute.size as usize;
    let pick = |numbers: &[f32], stride: usize, first: usize| -> Vec<f32> {
        let row = |vertex: usize| numbers.iter().skip(vertex * stride + first).take(size).copied();
        (0..count).flat_map(row).collect()
    };
    let values = match attribute.source {
        Source::Position => AttributeValues::Float(emission.positions.iter().flatten().copied().collect()),
        Source::PointSize => AttributeValues::Float(emission.sizes.clone()),
        Source::ClipDistance(index) => {
            let (stride, numbers) = &emission.distances;
            AttributeValues::Float(pick(numbers, *stride, index as usize))
        }
        Source::PrimitiveId => AttributeValues::Int(emission.ids.iter().map(|id| *id as i32).collect()),
        Source::Output(global, flat) if attribute.scalar == Scalar::Float => {
            let (places, numbers) = &emission.floats;
            let first = places.iter().position(|place| *place == (global, flat)).unwrap_or(0);
            AttributeValues::Float(pick(numbers, places.len(), first))
        }
        Source::Output(global, flat) => {
            let (places, numbers) = &emission.ints;
            let first = places.iter().position(|place| *place == (global, flat)).unwrap_or(0);
            let row = |vertex: usize| numbers.iter().skip(vertex * places.len() + first).take(size).copied();
            let rows = (0..count).flat_map(row);
            match attribute.scalar {
                Scalar::Uint => AttributeValues::Uint(rows.collect()),
                _ => AttributeValues::Int(rows.map(|bits| bits as i32).collect()),
            }
        }
    };
    AttributeData { size: attribute.size, divisor: 0, values }
}
