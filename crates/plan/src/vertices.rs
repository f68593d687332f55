//! Packs attribute data into vertex buffers.
//!
//! *In:* a draw's attributes. *Out:* at most two buffers, one with a row per vertex and one with a row per instance,
//! and their layouts. Every column is expanded to its declared type (missing components from (0, 0, 0, 1)), because a
//! format shorter than the shader's input would get other defaults, or none for integers. Divisors above 1, which
//! WebGPU lacks, become one row per instance.

use glisten_front::hir::{Scalar, ScalarValue, Type, TypeId, Types};
use glisten_front::link::Attribute;
use glisten_scene::{AttributeData, Draw};
use wgpu_types as wgpu;

/// One vertex buffer.
pub struct Rows {
    /// The bytes of all rows.
    pub bytes: Vec<u8>,
    /// The stride of a row in bytes.
    pub stride: u64,
    /// Whether there is a row per vertex or per instance.
    pub step: wgpu::VertexStepMode,
    /// The columns of a row.
    pub columns: Vec<wgpu::VertexAttribute>,
}

/// A column: the data for one location.
struct Column<'a> {
    data: Option<&'a AttributeData>,
    location: u32,
    index: u32,
    scalar: Scalar,
    height: u32,
}

/// The buffers of a draw; empty if its program has no attributes.
pub fn rows(draw: &Draw) -> Vec<Rows> {
    let program = &draw.program;
    let columns = columns(&program.interface.attributes, &draw.attributes, &program.types);
    let (instanced, plain): (Vec<_>, Vec<_>) =
        columns.into_iter().partition(|column| column.data.is_some_and(|data| data.divisor > 0));
    let vertices = match &draw.indices {
        Some(indices) => indices.iter().max().map_or(0, |last| last + 1),
        None => draw.vertex_count,
    };
    let mut buffers = Vec::new();
    if !plain.is_empty() {
        buffers.push(fill(&plain, 0..vertices, wgpu::VertexStepMode::Vertex));
    }
    if !instanced.is_empty() {
        buffers.push(fill(&instanced, 0..draw.instances, wgpu::VertexStepMode::Instance));
    }
    buffers
}

/// The buffers of points that are drawn as instances: a row per point, in the order of the draw.
pub fn rows_of_points(draw: &Draw) -> Vec<Rows> {
    let program = &draw.program;
    let columns = columns(&program.interface.attributes, &draw.attributes, &program.types);
    if columns.is_empty() {
        return Vec::new();
    }
    let step = wgpu::VertexStepMode::Instance;
    vec![match &draw.indices {
        Some(indices) => fill(&columns, indices.iter().copied(), step),
        None => fill(&columns, 0..draw.vertex_count, step),
    }]
}

/// All columns by location. Where two attributes share a location (legal as long as no path reads both), the active
/// one with data wins.
fn columns<'a>(attributes: &[Attribute], data: &'a [Option<AttributeData>], types: &Types) -> Vec<Column<'a>> {
    let mut order: Vec<usize> = (0..attributes.len()).collect();
    order.sort_by_key(|&index| (!attributes[index].active, data.get(index).is_none_or(Option::is_none)));
    let mut columns: Vec<Column<'a>> = Vec::new();
    for index in order {
        let attribute = &attributes[index];
        let Some((scalar, height)) = shape(types, attribute.ty) else { continue };
        for column in 0..attribute.columns {
            let location = attribute.location + column;
            if columns.iter().all(|other| other.location != location) {
                let data = data.get(index).and_then(Option::as_ref);
                columns.push(Column { data, location, index: column, scalar, height });
            }
        }
    }
    columns.sort_by_key(|column| column.location);
    columns
}

/// The scalar type and number of components at one location of an attribute.
fn shape(types: &Types, ty: TypeId) -> Option<(Scalar, u32)> {
    match types.get(ty) {
        Type::Scalar(scalar) => Some((scalar, 1)),
        Type::Vector(scalar, size) => Some((scalar, u32::from(size))),
        Type::Matrix(_, rows) => Some((Scalar::Float, u32::from(rows))),
        Type::Array(element, _) => shape(types, element),
        Type::Error | Type::Void | Type::Sampler(_) | Type::Struct(_) => None,
    }
}

fn fill(columns: &[Column<'_>], rows: impl Iterator<Item = u32>, step: wgpu::VertexStepMode) -> Rows {
    let mut layout = Vec::new();
    let mut stride = 0;
    for column in columns {
        layout.push(wgpu::VertexAttribute {
            format: format(column.scalar, column.height),
            offset: stride,
            shader_location: column.location,
        });
        stride += u64::from(column.height) * 4;
    }
    let mut bytes = Vec::with_capacity(stride as usize * rows.size_hint().0);
    for row in rows {
        for column in columns {
            for component in 0..column.height {
                bytes.extend(component_bytes(column, row, component));
            }
        }
    }
    Rows { bytes, stride, step, columns: layout }
}

/// The bytes of a component. A row is a vertex or an instance, which the divisor determines.
fn component_bytes(column: &Column<'_>, row: u32, component: u32) -> [u8; 4] {
    let value = match column.data {
        Some(data) => data.fetch(row, row, column.index, column.height, component),
        None => ScalarValue::Uint(0),
    };
    match (column.scalar, value) {
        (Scalar::Float, ScalarValue::Float(value)) => value.to_ne_bytes(),
        (Scalar::Float, ScalarValue::Int(value)) => (value as f32).to_ne_bytes(),
        (Scalar::Float, ScalarValue::Uint(value)) => (value as f32).to_ne_bytes(),
        (_, ScalarValue::Int(value)) => value.to_ne_bytes(),
        (_, ScalarValue::Uint(value)) => value.to_ne_bytes(),
        (_, ScalarValue::Float(value)) => (value as i32).to_ne_bytes(),
        (_, ScalarValue::Bool(value)) => u32::from(value).to_ne_bytes(),
    }
}

fn format(scalar: Scalar, height: u32) -> wgpu::VertexFormat {
    use wgpu::VertexFormat as F;
    let [floats, ints, uints] = [
        [F::Float32, F::Float32x2, F::Float32x3, F::Float32x4],
        [F::Sint32, F::Sint32x2, F::Sint32x3, F::Sint32x4],
        [F::Uint32, F::Uint32x2, F::Uint32x3, F::Uint32x4],
    ];
    let row = match scalar {
        Scalar::Float => floats,
        Scalar::Int => ints,
        Scalar::Uint | Scalar::Bool => uints,
    };
    row[(height.clamp(1, 4) - 1) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_front::hir::GlobalId;
    use glisten_scene::AttributeValues;

    fn attribute(ty: TypeId, location: u32, columns: u32, active: bool) -> Attribute {
        Attribute { name: "a".into(), ty, global: GlobalId::new(0), location, columns, active }
    }

    fn floats(size: u32, values: &[f32]) -> Option<AttributeData> {
        Some(AttributeData { size, divisor: 0, values: AttributeValues::Float(values.to_vec()) })
    }

    #[test]
    fn missing_components_become_0_0_0_1() {
        let data = [floats(3, &[1.0, 2.0, 3.0])];
        let columns = columns(&[attribute(TypeId::VEC4, 2, 1, true)], &data, &Types::new());
        let rows = fill(&columns, 0..1, wgpu::VertexStepMode::Vertex);
        let floats: Vec<f32> = rows.bytes.chunks(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect();
        assert_eq!(floats, [1.0, 2.0, 3.0, 1.0]);
        assert_eq!(rows.stride, 16);
        assert_eq!(rows.columns[0].shader_location, 2);
    }

    #[test]
    fn a_matrix_takes_a_location_a_column() {
        let data = [floats(6, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])];
        let columns = columns(&[attribute(TypeId::matrix(2, 3), 1, 2, true)], &data, &Types::new());
        let rows = fill(&columns, 0..1, wgpu::VertexStepMode::Vertex);
        assert_eq!(rows.columns.iter().map(|c| (c.shader_location, c.offset)).collect::<Vec<_>>(), [(1, 0), (2, 12)]);
        assert_eq!(rows.bytes.len(), 24);
    }

    #[test]
    fn the_active_one_of_two_at_a_location_wins() {
        let attributes = [attribute(TypeId::VEC4, 0, 1, false), attribute(TypeId::VEC2, 0, 1, true)];
        let data = [floats(1, &[5.0]), floats(1, &[7.0])];
        let columns = columns(&attributes, &data, &Types::new());
        assert_eq!(columns.len(), 1);
        assert_eq!(columns[0].height, 2);
    }
}
