//! Colors in 8 bits a channel.
//!
//! *In:* colors as a fragment shader wrote them. *Out:* bytes, clamped to [0, 1] and rounded, without gamma.

/// The color that shows a number that is not finite: magenta.
pub const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// `round(255 x)` of `x` clamped to [0, 1]; 0 for NaN.
pub fn byte(value: f64) -> u8 {
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

/// Red, green and blue as bytes; [`NOT_FINITE`] if one of them is not finite.
pub fn visible_rgb([red, green, blue, _]: [f64; 4]) -> [u8; 3] {
    let rgb = [red, green, blue];
    if rgb.iter().all(|channel| channel.is_finite()) { rgb.map(byte) } else { NOT_FINITE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_clamped_and_rounded() {
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 9.0, f64::NAN].map(byte), [0, 0, 128, 255, 255, 0]);
        assert_eq!(visible_rgb([0.25, 2.0, 0.0, f64::NAN]), [64, 255, 0]);
        assert_eq!(visible_rgb([0.25, f64::INFINITY, 0.0, 1.0]), NOT_FINITE);
    }
}
