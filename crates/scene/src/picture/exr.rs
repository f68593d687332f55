//! OpenEXR, float32.
//!
//! *In:* RGBA numbers, or a file's bytes. *Out:* the respective other. *Not done here:* deep pictures, layers after
//! the first one with colors, color spaces.

use super::image::{Image, ImageError, Size};
use exr::prelude::*;
use std::io::Cursor;

/// The first bytes of every such file.
pub(super) const MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

pub(super) fn write(width: u32, height: u32, pixels: &[[f64; 4]]) -> std::result::Result<Vec<u8>, ImageError> {
    let size = Vec2(width as usize, height as usize);
    let color = |at: Vec2<usize>| {
        let [red, green, blue, alpha] = pixels.get(at.flat_index_for_size(size)).copied().unwrap_or_default();
        (red as f32, green as f32, blue as f32, alpha as f32)
    };
    let mut bytes = Cursor::new(Vec::new());
    let image = exr::prelude::Image::from_channels(size, SpecificChannels::rgba(color));
    image.write().to_buffered(&mut bytes).map_err(message)?;
    Ok(bytes.into_inner())
}

/// The bytes of a file of red, green and blue in 16-bit floats, compressed. `pixels` has `width * height` colors, top row first.
///
/// # Errors
/// A side is 0, or there are too few colors.
pub fn exr_of_colors(width: u32, height: u32, pixels: &[[f32; 3]]) -> std::result::Result<Vec<u8>, ImageError> {
    let size = Vec2(width as usize, height as usize);
    if pixels.len() != size.area() || size.area() == 0 {
        return Err(ImageError(format!("it has {} colors for {width} by {height} pixels", pixels.len())));
    }
    let color = |at: Vec2<usize>| {
        let [red, green, blue] = pixels.get(at.flat_index_for_size(size)).copied().unwrap_or_default();
        (f16::from_f32(red), f16::from_f32(green), f16::from_f32(blue))
    };
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::FAST_LOSSLESS };
    let image = exr::prelude::Image::from_encoded_channels(size, encoding, SpecificChannels::rgb(color));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(message)?;
    Ok(bytes.into_inner())
}

/// Reads the first layer with red, green and blue. Pixels outside its data window are black.
pub(super) fn read(bytes: &[u8], size: Size) -> std::result::Result<Image, ImageError> {
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(message)?;
    let has_colors = |header: &&exr::meta::header::Header| {
        let has = |name: &str| header.channels.find_index_of_channel(&Text::from(name)).is_some();
        !header.deep && ["R", "G", "B"].into_iter().all(has)
    };
    let header = reader.headers().iter().find(has_colors);
    let header = header.ok_or_else(|| ImageError("it has no layer with red, green and blue".to_owned()))?;
    let window = header.shared_attributes.display_window;
    let offset = header.own_attributes.layer_position - window.position;
    let (width, height) = size.check(window.size.width(), window.size.height())?;
    let has_alpha = header.channels.find_index_of_channel(&Text::from("A")).is_some();
    let absent = [0.0, 0.0, 0.0, if has_alpha { 0.0 } else { 1.0 }];
    size.bound(header.layer_size.width(), header.layer_size.height())?;
    let place = move |at: Vec2<usize>| {
        let at = at.to_i32() + offset;
        let (x, y) = (u32::try_from(at.x()).ok()?, u32::try_from(at.y()).ok()?);
        (x < width && y < height).then_some(y as usize * width as usize + x as usize)
    };
    let read = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            move |_, _| vec![absent; width as usize * height as usize],
            move |pixels: &mut Vec<[f32; 4]>, at, (red, green, blue, alpha): (f32, f32, f32, f32)| {
                if let Some(pixel) = place(at).and_then(|index| pixels.get_mut(index)) {
                    *pixel = [red, green, blue, alpha];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_chunks(reader)
        .map_err(message)?;
    Ok(Image { width, height, pixels: read.layer_data.channel_data.pixels })
}

fn message(error: Error) -> ImageError {
    ImageError(error.to_string())
}
