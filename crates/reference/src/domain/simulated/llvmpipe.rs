//! The sine and the cosine of llvmpipe, bit for bit.
//!
//! *In:* an angle in f32. *Out:* what Mesa's `lp_build_sin` and `lp_build_cos` compute of it: the angle is reduced to an octant by
//! a product with pi/4 in three parts, and a polynomial of Cephes is evaluated there. *Holds:* all numbers are f32. Where the
//! processor has fused products, LLVM uses them. A test compares it with the driver over the octants
//! (`cargo test --test it -- envelope::the_sine_of_llvmpipe`).

/// Octants in a radian.
const OCTANTS: f32 = 1.273_239_5;
/// Minus pi/4, in three parts.
const QUARTER: [f32; 3] = [-0.785_156_25, -2.418_756_5e-4, -3.774_895e-8];
/// Of the cosine: the powers 8, 6 and 4.
const COSINE: [f32; 3] = [2.443_315_7e-5, -1.388_731_6e-3, 4.166_664_6e-2];
/// Of the sine: the powers 7, 5 and 3.
const SINE: [f32; 3] = [-1.951_529_6e-4, 8.332_161e-3, -1.666_665_5e-1];

/// The sine of an angle, or its cosine.
pub(super) fn sine(angle: f64, is_cosine: bool, fused: bool) -> f64 {
    let times = |a: f32, b: f32, c: f32| if fused { a.mul_add(b, c) } else { a * b + c };
    let angle = angle as f32;
    let size = angle.abs();
    // Beyond what an `int` holds the driver has no octant either.
    let octant = ((size * OCTANTS) as i32).saturating_add(1) & !1;
    let rest = QUARTER.iter().fold(size, |rest, part| times(octant as f32, *part, rest));
    let turned = if is_cosine { octant.wrapping_sub(2) } else { octant };
    let is_negative = if is_cosine { !turned & 4 != 0 } else { (turned & 4 != 0) != (angle < 0.0) };
    let square = rest * rest;
    let value = if turned & 2 == 0 {
        let sum = times(times(square, SINE[0], SINE[1]), square, SINE[2]) * square;
        times(sum, rest, rest)
    } else {
        let sum = times(times(square, COSINE[0], COSINE[1]), square, COSINE[2]) * square * square;
        sum - square * 0.5 + 1.0
    };
    f64::from(if is_negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::sine;

    #[test]
    fn it_is_a_sine_and_a_cosine() {
        for fused in [false, true] {
            for place in -4000..4000 {
                let angle = f64::from(place as f32 * 0.013);
                assert!((sine(angle, false, fused) - angle.sin()).abs() < 2e-7, "{angle}");
                assert!((sine(angle, true, fused) - angle.cos()).abs() < 2e-7, "{angle}");
            }
        }
    }
}
