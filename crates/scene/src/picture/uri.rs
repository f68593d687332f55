//! Pictures as data URIs (RFC 2397), which pages hold.
//!
//! *In:* pixels or a picture. *Out:* PNG in base64 (RFC 4648 §4). *Holds:* colors are clamped to [0, 1] and rounded to 8 bits, encoded as the
//! scene says; non-finite colors are magenta.

use super::Picture;
use super::eight_bits::visible_rgb;
use super::png::{Effort, png_rgb};
use super::tone::Encoding;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// The data URI of a PNG file.
pub fn png_uri(file: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(file))
}

/// The data URI of some pixels: `width * height`, top row first.
pub fn data_uri(pixels: &[[u8; 3]], width: u32, height: u32, effort: Effort) -> String {
    // Writing to memory fails only if the sizes disagree; an empty picture shows that better than no page at all.
    png_uri(&png_rgb(width, height, pixels, effort).unwrap_or_default())
}

/// The first attachment in 8 bits.
pub fn colors(picture: &Picture, by: impl Into<Encoding>) -> Vec<[u8; 3]> {
    let by = by.into();
    let pixels = picture.attachments.first().map(Vec::as_slice).unwrap_or_default();
    pixels.iter().map(|&pixel| visible_rgb(by.encode_pixel(pixel))).collect()
}

/// The first attachment as a data URI.
pub fn color_uri(picture: &Picture, by: impl Into<Encoding>) -> String {
    data_uri(&colors(picture, by), picture.width, picture.height, Effort::Fast)
}

#[cfg(test)]
mod tests {
    use super::png_uri;

    #[test]
    fn base64_of_rfc_4648() {
        assert_eq!(png_uri(b"fooba"), "data:image/png;base64,Zm9vYmE=");
    }
}
