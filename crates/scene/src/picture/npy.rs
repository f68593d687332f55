//! NumPy's array files (NEP 1), float32 `[height, width, 4]`.
//!
//! *In:* RGBA numbers, or a file's bytes. *Out:* the respective other.

use super::image::{Image, ImageError, Size};

/// The first bytes of every such file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// The data begins at a multiple of this offset.
const ALIGNMENT: usize = 64;
/// Magic, version and the length of the header's text.
const PREFIX: usize = MAGIC.len() + 4;

/// A file of version 1.0.
pub(super) fn write(width: u32, height: u32, pixels: &[[f64; 4]]) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}, 4, ), }}").into_bytes();
    let end = (PREFIX + header.len() + 1).next_multiple_of(ALIGNMENT);
    header.resize(end - PREFIX - 1, b' ');
    header.push(b'\n');
    let mut bytes = Vec::with_capacity(end + pixels.len() * 16);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&[1, 0]);
    // Two numbers of at most ten digits: the header has two lines of 64 bytes, three at most.
    bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
    bytes.extend_from_slice(&header);
    bytes.extend(pixels.iter().flatten().flat_map(|&value| (value as f32).to_le_bytes()));
    bytes
}

/// Reads a float32 array `[height, width, 4]` in C order, from [`write`] or `numpy.save`.
pub(super) fn read(bytes: &[u8], size: Size) -> Result<Image, ImageError> {
    let damaged = || ImageError("it is not a whole NumPy file".to_owned());
    let [major, _, low, high] = *bytes.get(MAGIC.len()..).and_then(<[u8]>::first_chunk).ok_or_else(damaged)?;
    if major != 1 {
        return Err(ImageError(format!("it is a NumPy file of version {major}, not 1")));
    }
    let end = PREFIX + usize::from(u16::from_le_bytes([low, high]));
    let header = bytes.get(PREFIX..end).and_then(|text| str::from_utf8(text).ok()).ok_or_else(damaged)?;
    let shape = shape(header).ok_or_else(damaged)?;
    let [height, width, 4] = shape[..] else {
        return Err(ImageError(format!("its shape is {shape:?}, not [height, width, 4]")));
    };
    if !header.contains("'<f4'") || !header.contains("'fortran_order': False") {
        return Err(ImageError("its numbers are not little-endian float32 in C order".to_owned()));
    }
    let (width, height) = size.check(width, height)?;
    let data = bytes.get(end..).unwrap_or_default().as_chunks::<4>().0;
    let pixels: Vec<[f32; 4]> = data.as_chunks::<4>().0.iter().map(|color| color.map(f32::from_le_bytes)).collect();
    if pixels.len() != width as usize * height as usize {
        return Err(damaged());
    }
    Ok(Image { width, height, pixels })
}

/// The numbers of `'shape': (2, 3, 4)`.
fn shape(header: &str) -> Option<Vec<usize>> {
    let list = header.split_once("'shape': (")?.1.split_once(')')?.0;
    list.split(',').map(str::trim).filter(|number| !number.is_empty()).map(|number| number.parse().ok()).collect()
}
