//! Uploads vertex data (OpenGL 3.2 §2.8, §2.10).
//!
//! *In:* a draw's attributes and indices. *Out:* a vertex array with a buffer for each attribute. *Holds:* OpenGL
//! fills in components that the data lacks. No draw reads past the end of a buffer.

use super::api::Api;
use super::{Error, fixed, programs};
use glisten_front::hir::{Scalar, Type, TypeId, Types};
use glisten_front::link::Attribute;
use glisten_scene::{AttributeData, AttributeValues, Draw};

/// Binds the vertex data of a draw.
pub(super) fn bind(api: &Api, draw: &Draw) -> Result<(), Error> {
    let array = api.create_vertex_array().map_err(Error::Refused)?;
    api.bind_vertex_array(Some(array));
    let vertices = match &draw.indices {
        Some(indices) => indices.iter().max().map_or(0, |last| last.saturating_add(1)),
        None => draw.vertex_count,
    };
    for (attribute, data) in draw.program.interface.attributes.iter().zip(&draw.attributes) {
        // Inactive attributes may share a location with active ones, and nothing reads them.
        let Some(data) = data.as_ref().filter(|_| attribute.active) else { continue };
        let rows = draw.instances.checked_next_multiple_of(data.divisor.max(1)).unwrap_or(u32::MAX);
        let rows = rows.checked_div(data.divisor).unwrap_or(vertices);
        if (data.values.len() as u64) < u64::from(rows) * u64::from(data.size) {
            return Err(Error::Refused(format!("`{}` has fewer rows than are drawn", attribute.name)));
        }
        if let Some(old) = api.old().filter(|_| attribute.name.starts_with("gl_")) {
            let widened = fixed::widened(&attribute.name, data);
            let data = widened.as_ref().unwrap_or(data);
            fill(api, glow::ARRAY_BUFFER, &bytes(&data.values))?;
            fixed::feed(old, &attribute.name, data)?;
            continue;
        }
        feed(api, attribute, data, &draw.program.types)?;
    }
    if let Some(indices) = &draw.indices {
        let bytes: Vec<u8> = indices.iter().copied().flat_map(u32::to_ne_bytes).collect();
        fill(api, glow::ELEMENT_ARRAY_BUFFER, &bytes)?;
    }
    api.check("binding vertex data")
}

fn fill(api: &Api, target: u32, bytes: &[u8]) -> Result<(), Error> {
    let buffer = api.create_buffer().map_err(Error::Refused)?;
    api.bind_buffer(target, Some(buffer));
    api.buffer_data_u8_slice(target, bytes, glow::STATIC_DRAW);
    Ok(())
}

/// The scalar type and number of components at one location of an attribute.
fn column(types: &Types, ty: TypeId) -> Option<(Scalar, u32)> {
    match types.get(ty) {
        Type::Scalar(scalar) => Some((scalar, 1)),
        Type::Vector(scalar, size) => Some((scalar, u32::from(size))),
        Type::Matrix(_, rows) => Some((Scalar::Float, u32::from(rows))),
        Type::Array(element, _) => column(types, element),
        Type::Error | Type::Void | Type::Sampler(_) | Type::Struct(_) => None,
    }
}

fn feed(api: &Api, attribute: &Attribute, data: &AttributeData, types: &Types) -> Result<(), Error> {
    let Some((scalar, height)) = column(types, attribute.ty) else { return Ok(()) };
    fill(api, glow::ARRAY_BUFFER, &bytes(&data.values))?;
    let stride = data.size as i32 * 4;
    for index in 0..attribute.columns {
        let location = programs::first_location(api) + attribute.location + index;
        let start = index * height;
        let present = data.size.saturating_sub(start).min(height) as i32;
        let offset = start as i32 * 4;
        if present == 0 {
            // A column for which the data has no values.
            api.vertex_attrib_4_f32(location, 0.0, 0.0, 0.0, 1.0);
            continue;
        }
        api.enable_vertex_attrib_array(location);
        match scalar {
            Scalar::Float => api.vertex_attrib_pointer_f32(location, present, glow::FLOAT, false, stride, offset),
            Scalar::Int => api.vertex_attrib_pointer_i32(location, present, glow::INT, stride, offset),
            Scalar::Uint | Scalar::Bool => {
                api.vertex_attrib_pointer_i32(location, present, glow::UNSIGNED_INT, stride, offset);
            }
        }
        if data.divisor > 0 {
            if api.version() < (3, 3) {
                return Err(Error::Unsupported("attributes an instance (OpenGL 3.3)".to_owned()));
            }
            api.vertex_attrib_divisor(location, data.divisor);
        }
    }
    Ok(())
}

fn bytes(values: &AttributeValues) -> Vec<u8> {
    match values {
        AttributeValues::Float(values) => values.iter().copied().flat_map(f32::to_ne_bytes).collect(),
        AttributeValues::Int(values) => values.iter().copied().flat_map(i32::to_ne_bytes).collect(),
        AttributeValues::Uint(values) => values.iter().copied().flat_map(u32::to_ne_bytes).collect(),
    }
}
