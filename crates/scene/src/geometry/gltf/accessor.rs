//! Reads the numbers of an accessor (glTF 2.0 §3.6.2).
//!
//! *In:* an accessor and its views. *Out:* its components as f64, in order. *Holds:* an accessor that reaches past its view is an
//! error, so that memory is bounded by the file's size.

use super::super::MAX_TRIANGLES;
use super::buffers::Buffers;
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

/// The largest number of elements.
const MAX_COUNT: u64 = 3 * MAX_TRIANGLES as u64;

/// The components of all elements, and how many an element has.
pub(super) struct Numbers {
    pub(super) values: Vec<f64>,
    pub(super) width: usize,
}

impl Numbers {
    /// The elements as arrays; missing components are from `fill`.
    pub(super) fn rows<const N: usize>(&self, fill: [f64; N]) -> Vec<[f64; N]> {
        let row = |element: &[f64]| {
            let mut row = fill;
            for (into, value) in row.iter_mut().zip(element) {
                *into = *value;
            }
            row
        };
        self.values.chunks_exact(self.width.max(1)).map(row).collect()
    }
}

/// Reads an accessor.
pub(super) fn read(root: &Root, buffers: &mut Buffers<'_>, index: Index<Accessor>) -> Result<Numbers, String> {
    let number = index.value();
    let accessor = root.get(index).ok_or_else(|| format!("there is no accessor {number}"))?;
    values(root, buffers, accessor).map_err(|error| format!("accessor {number}: {error}"))
}

/// Reads an accessor of the indices of vertices (§3.7.2.1).
pub(super) fn indices(root: &Root, buffers: &mut Buffers<'_>, index: Index<Accessor>) -> Result<Vec<u32>, String> {
    let numbers = read(root, buffers, index)?;
    let kind = root.get(index).map(|accessor| accessor.component_type);
    let is_unsigned = matches!(
        kind,
        Some(Checked::Valid(GenericComponentType(ComponentType::U8 | ComponentType::U16 | ComponentType::U32)))
    );
    if !is_unsigned || numbers.width != 1 {
        return Err(format!(
            "accessor {}: indices are single unsigned integers, and it has other elements",
            index.value()
        ));
    }
    Ok(numbers.values.into_iter().map(|value| value as u32).collect())
}

fn values(root: &Root, buffers: &mut Buffers<'_>, accessor: &Accessor) -> Result<Numbers, String> {
    let Checked::Valid(GenericComponentType(kind)) = accessor.component_type else {
        return Err("its component type is unknown".to_owned());
    };
    let Checked::Valid(shape) = accessor.type_ else { return Err("its type is unknown".to_owned()) };
    let count = accessor.count.0;
    if count > MAX_COUNT {
        return Err(format!("it has {count} elements, and at most {MAX_COUNT} are read"));
    }
    let (count, width) = (count as usize, components(shape));
    let component = Component { kind, normalized: accessor.normalized };
    let mut values = match accessor.buffer_view {
        None => vec![0.0; count * width],
        Some(view) => {
            let stride = root.get(view).and_then(|view| view.byte_stride).map(|stride| stride.0);
            let bytes = buffers.view(view)?;
            let start = accessor.byte_offset.map_or(0, |offset| offset.0);
            component.read(bytes, start, stride, (count, width))?
        }
    };
    if let Some(sparse) = &accessor.sparse {
        if sparse.count.0 > accessor.count.0 {
            return Err(format!("{} of its {count} elements are sparse", sparse.count.0));
        }
        let n_changed = sparse.count.0 as usize;
        let Checked::Valid(index) = sparse.indices.component_type else {
            return Err("the type of its sparse indices is unknown".to_owned());
        };
        let index = Component { kind: index.0, normalized: false };
        let bytes = buffers.view(sparse.indices.buffer_view)?;
        let rows = index.read(bytes, sparse.indices.byte_offset.0, None, (n_changed, 1))?;
        let bytes = buffers.view(sparse.values.buffer_view)?;
        let changed = component.read(bytes, sparse.values.byte_offset.0, None, (n_changed, width))?;
        for (row, new) in rows.iter().zip(changed.chunks_exact(width.max(1))) {
            let start = *row as usize * width;
            let old = values.get_mut(start..start + width).ok_or("a sparse index is past its end")?;
            old.copy_from_slice(new);
        }
    }
    Ok(Numbers { values, width })
}

fn components(shape: Type) -> usize {
    match shape {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

/// A component of an element.
#[derive(Clone, Copy)]
struct Component {
    kind: ComponentType,
    normalized: bool,
}

impl Component {
    fn size(self) -> usize {
        match self.kind {
            ComponentType::I8 | ComponentType::U8 => 1,
            ComponentType::I16 | ComponentType::U16 => 2,
            ComponentType::U32 | ComponentType::F32 => 4,
        }
    }

    fn read(
        self,
        bytes: &[u8],
        start: u64,
        stride: Option<usize>,
        (count, width): (usize, usize),
    ) -> Result<Vec<f64>, String> {
        let element = self.size() * width;
        let stride = stride.unwrap_or(element).max(1);
        let past = || format!("its {count} elements reach past the {} bytes of its view", bytes.len());
        let start = usize::try_from(start).map_err(|_| past())?;
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(start)?.checked_add(element));
        if needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(past());
        }
        let mut values = Vec::with_capacity(count * width);
        for row in 0..count {
            let at = start + row * stride;
            let element = bytes.get(at..at + element).unwrap_or(&[]);
            values.extend(element.chunks_exact(self.size()).map(|component| self.value(component)));
        }
        if values.iter().all(|value| value.is_finite()) {
            Ok(values)
        } else {
            Err("it has numbers that are not finite".to_owned())
        }
    }

    /// One number, little-endian; integers that are normalized become [0, 1] or [-1, 1] (§3.6.2.2).
    fn value(self, bytes: &[u8]) -> f64 {
        let two = || <[u8; 2]>::try_from(bytes).unwrap_or_default();
        let four = || <[u8; 4]>::try_from(bytes).unwrap_or_default();
        let first = bytes.first().copied().unwrap_or(0);
        let (value, most) = match self.kind {
            ComponentType::I8 => (f64::from(first.cast_signed()), 127.0),
            ComponentType::U8 => (f64::from(first), 255.0),
            ComponentType::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
            ComponentType::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
            ComponentType::U32 => (f64::from(u32::from_le_bytes(four())), 4_294_967_295.0),
            ComponentType::F32 => return f64::from(f32::from_le_bytes(four())),
        };
        if self.normalized { (value / most).max(-1.0) } else { value }
    }
}
