//! [`coefficients`]: the nine spherical harmonics of a panorama, in the order of the module `irradiance`.

use super::panorama::Panorama;
use crate::measure::vector::V;

/// The nine functions (Ramamoorthi and Hanrahan 2001).
pub(super) fn functions([x, y, z]: V) -> [f64; 9] {
    let (zero, one, two) = (0.282_095, 0.488_603, 1.092_548);
    [
        zero,
        one * y,
        one * z,
        one * x,
        two * x * y,
        two * y * z,
        0.315_392 * (3.0 * z * z - 1.0),
        two * x * z,
        0.546_274 * (x * x - y * y),
    ]
}

/// L_00, L_1-1, L_10, L_11, L_2-2, L_2-1, L_20, L_21, L_22 for each channel.
pub fn coefficients(panorama: &Panorama) -> [V; 9] {
    let mut sums = [[0.0; 3]; 9];
    for (d, solid, radiance) in panorama.parts(usize::MAX) {
        for (sum, value) in sums.iter_mut().zip(functions(d)) {
            sum.iter_mut().zip(radiance).for_each(|(sum, channel)| *sum += solid * value * channel);
        }
    }
    sums
}
