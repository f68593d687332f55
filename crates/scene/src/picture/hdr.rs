//! Radiance's HDR files (RGBE): reading only.
//!
//! *In:* bytes: a header of lines, then rows of pixels, each of three mantissas and an exponent. *Out:* an [`Image`] of linear light.
//! *Holds:* rows come as they are, or in runs, of the new form (each channel by itself) or of the old one (a pixel that repeats). Sizes are
//! checked before memory is allocated; `EXPOSURE` and `COLORCORR` are divided out, so that values are radiance.

use super::image::{Image, ImageError, Size};

/// The most lines of a header.
const MAX_LINES: usize = 1000;

/// Whether these are the first bytes of such a file.
pub(super) fn is_hdr(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?RADIANCE") || bytes.starts_with(b"#?RGBE")
}

fn wrong(what: &str) -> ImageError {
    ImageError(format!("the HDR file cannot be read: {what}"))
}

/// Bytes that are read in order.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn next(&mut self) -> Result<u8, ImageError> {
        let (first, rest) = self.0.split_first().ok_or_else(|| wrong("it has too few pixels"))?;
        self.0 = rest;
        Ok(*first)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], ImageError> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| wrong("it has too few pixels"))?;
        self.0 = rest;
        Ok(taken)
    }

    fn line(&mut self) -> Result<&'a str, ImageError> {
        let end = self.0.iter().position(|byte| *byte == b'\n').ok_or_else(|| wrong("its header has no end"))?;
        let (line, rest) = self.0.split_at(end);
        self.0 = rest.get(1..).unwrap_or_default();
        std::str::from_utf8(line).map(str::trim).map_err(|_| wrong("its header is no text"))
    }
}

/// Reads a file.
pub(super) fn read(bytes: &[u8], allowed: Size) -> Result<Image, ImageError> {
    let mut bytes = Bytes(bytes);
    let factors = header(&mut bytes)?;
    let resolution = bytes.line()?;
    let parts: Vec<&str> = resolution.split_whitespace().collect();
    let (is_flipped, height, width) = match parts[..] {
        ["-Y", height, "+X", width] => (false, height, width),
        ["+Y", height, "+X", width] => (true, height, width),
        _ => return Err(wrong("its rows are not from left to right: `-Y height +X width` is read")),
    };
    let side = |text: &str| text.parse::<usize>().map_err(|_| wrong("its size is no number"));
    let (width, height) = allowed.check(side(width)?, side(height)?)?;
    let mut pixels = Vec::new();
    for _ in 0..height {
        let row = row(&mut bytes, width as usize)?;
        pixels.extend(row.into_iter().map(|texel| color(texel, factors)));
    }
    let image = Image { width, height, pixels };
    Ok(if is_flipped { image.flipped() } else { image })
}

/// Reads the lines up to the empty one. Returns by what each channel is multiplied.
fn header(bytes: &mut Bytes<'_>) -> Result<[f32; 3], ImageError> {
    let mut factors = [1.0_f32; 3];
    for _ in 0..MAX_LINES {
        let line = bytes.line()?;
        if line.is_empty() {
            return Ok(factors);
        }
        let Some((key, value)) = line.split_once('=') else { continue };
        let numbers: Vec<f32> = value.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        match (key.trim(), &numbers[..]) {
            ("FORMAT", _) if value.trim() != "32-bit_rle_rgbe" => {
                return Err(wrong("its FORMAT is not `32-bit_rle_rgbe`"));
            }
            ("EXPOSURE", [exposure]) => factors = factors.map(|factor| factor / exposure),
            ("COLORCORR", [r, g, b]) => factors = [factors[0] / r, factors[1] / g, factors[2] / b],
            _ => {}
        }
        if !factors.iter().all(|factor| factor.is_finite() && *factor > 0.0) {
            return Err(wrong("its exposure is no positive number"));
        }
    }
    Err(wrong(&format!("its header has more than {MAX_LINES} lines")))
}

/// A row of pixels.
fn row(bytes: &mut Bytes<'_>, width: usize) -> Result<Vec<[u8; 4]>, ImageError> {
    // A row of the new form begins with two twos and its width.
    let begin = [2, 2, (width >> 8) as u8, (width & 0xff) as u8];
    if (8..0x8000).contains(&width) && bytes.0.starts_with(&begin) {
        bytes.take(4)?;
        return channels(bytes, width);
    }
    let mut row: Vec<[u8; 4]> = Vec::new();
    let mut shift = 0;
    while row.len() < width {
        let texel: [u8; 4] = bytes.take(4)?.try_into().unwrap_or_default();
        if let ([1, 1, 1, count], Some(last)) = (texel, row.last().copied()) {
            let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
            if count > width - row.len() || shift > 24 {
                return Err(wrong("a run is longer than its row"));
            }
            row.resize(row.len() + count, last);
            shift += 8;
        } else {
            row.push(texel);
            shift = 0;
        }
    }
    Ok(row)
}

/// The four channels of a row, one after the other, each in runs.
fn channels(bytes: &mut Bytes<'_>, width: usize) -> Result<Vec<[u8; 4]>, ImageError> {
    let mut row = vec![[0; 4]; width];
    for channel in 0..4 {
        let mut at = 0;
        while at < width {
            let count = usize::from(bytes.next()?);
            let (count, run) = if count > 128 { (count - 128, Some(bytes.next()?)) } else { (count, None) };
            if count == 0 || count > width - at {
                return Err(wrong("a run is longer than its row"));
            }
            for texel in row.iter_mut().skip(at).take(count) {
                let value = match run {
                    Some(value) => value,
                    None => bytes.next()?,
                };
                if let Some(slot) = texel.get_mut(channel) {
                    *slot = value;
                }
            }
            at += count;
        }
    }
    Ok(row)
}

/// A mantissa m and an exponent e are (m + 1/2) 2^(e - 136), and black for e = 0 (Ward, Real Pixels, Graphics Gems II).
fn color([r, g, b, exponent]: [u8; 4], factors: [f32; 3]) -> [f32; 4] {
    if exponent == 0 {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let scale = f64::from(i32::from(exponent) - 136).exp2();
    let channel = |mantissa: u8, factor: f32| ((f64::from(mantissa) + 0.5) * scale * f64::from(factor)) as f32;
    [channel(r, factors[0]), channel(g, factors[1]), channel(b, factors[2]), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALLOWED: Size = Size { max_side: 64, max_pixels: 1024, shape: |_, _| Ok(()) };

    fn file(header: &str, pixels: &[u8]) -> Vec<u8> {
        [format!("#?RADIANCE\n{header}\n").as_bytes(), pixels].concat()
    }

    #[test]
    fn all_forms_of_rows_are_read() {
        let gray = [127, 127, 127, 129];
        let value = 127.5 / 128.0;
        // Plain, and a run of the old form.
        let plain = file("FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3", &[gray, [255, 0, 0, 128], [0, 0, 0, 0]].concat());
        let image = read(&plain, ALLOWED).expect("it is right");
        assert_eq!((image.width, image.height), (3, 1));
        assert_eq!(image.pixels[0], [value, value, value, 1.0]);
        assert_eq!(image.pixels[1], [255.5 / 256.0, 0.5 / 256.0, 0.5 / 256.0, 1.0]);
        assert_eq!(image.pixels[2], [0.0, 0.0, 0.0, 1.0]);
        let old = file("\n-Y 1 +X 6", &[gray, [1, 1, 1, 5]].concat());
        assert_eq!(read(&old, ALLOWED).expect("it is right").pixels, vec![[value, value, value, 1.0]; 6]);
        // The new form: 8 pixels, red counts, the others are runs.
        let mut new = vec![2, 2, 0, 8, 8, 0, 1, 2, 3, 4, 5, 6, 7];
        new.extend([128 + 8, 9, 128 + 5, 1, 3, 2, 2, 2, 128 + 8, 129]);
        let image = read(&file("EXPOSURE=2\n\n+Y 1 +X 8", &new), ALLOWED).expect("it is right");
        for (k, pixel) in image.pixels.iter().enumerate() {
            let blue = if k < 5 { 1.5 } else { 2.5 };
            assert_eq!(*pixel, [(k as f32 + 0.5) / 256.0, 9.5 / 256.0, blue / 256.0, 1.0]);
        }
    }

    #[test]
    fn damaged_files_are_refused() {
        let good = file("\n-Y 1 +X 8", &[&[2, 2, 0, 8][..], &[128 + 8, 9].repeat(4)].concat());
        assert!(read(&good, ALLOWED).is_ok());
        for len in 0..good.len() {
            assert!(read(&good[..len], ALLOWED).is_err(), "{len}");
        }
        for (header, pixels) in [
            ("FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1", &[1, 1, 1, 1][..]),
            ("\n-X 1 +Y 1", &[1, 1, 1, 1]),
            ("\n-Y 1 +X 65", &[0; 1024]),
            ("\n-Y 1 +X -1", &[0; 16]),
            ("EXPOSURE=0\n\n-Y 1 +X 1", &[1, 1, 1, 1]),
            ("\n-Y 1 +X 8", &[2, 2, 0, 8, 128 + 9, 1]),
            ("\n-Y 1 +X 8", &[2, 2, 0, 8, 0, 1]),
            ("\n-Y 1 +X 8", &[9, 9, 9, 9, 1, 1, 1, 200]),
        ] {
            assert!(read(&file(header, pixels), ALLOWED).is_err(), "{header}");
        }
    }
}
