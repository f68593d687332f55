//! Powers of two and logarithms for the bounds of envelopes, without calls, so that they run on vector units.
//!
//! *Holds:* the relative error of both is below 1e-13. That is less than [`OUTWARD`] adds to the three ULP or more of
//! their rules, so bounds computed with them are sound. No digit of a `value` comes from here.
//!
//! [`OUTWARD`]: super::round::OUTWARD

/// The largest relative error.
#[cfg(test)]
const MISSED: f64 = 1e-13;

const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 1023 << 52;

/// `log2` of a normal f64 that is greater than 0, or of infinity.
#[inline(always)]
pub(super) fn log2(x: f64) -> f64 {
    // 2^52: its lowest bits contain the integer that replaces them.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    // 2 / (ln(2) (2 k + 1))
    const SERIES: [f64; 8] = [
        2.885_390_081_777_926_8,
        0.961_796_693_925_975_6,
        0.577_078_016_355_585_4,
        0.412_198_583_111_132_4,
        0.320_598_897_975_325_2,
        0.262_308_189_252_538_8,
        0.221_953_083_213_686_7,
        0.192_359_338_785_195_1,
    ];
    let bits = x.to_bits();
    let exponent = f64::from_bits(WHOLE.to_bits() | bits >> 52) - WHOLE - 1023.0;
    let mantissa = f64::from_bits(bits & MANTISSA | ONE);
    let upper = mantissa > std::f64::consts::SQRT_2;
    let (exponent, m) = if upper { (exponent + 1.0, mantissa * 0.5) } else { (exponent, mantissa) };
    // log2(m) = 2 / ln(2) artanh((m - 1) / (m + 1)), whose argument is 0.17 at most.
    let t = (m - 1.0) / (m + 1.0);
    let square = t * t;
    let [c0, c1, c2, c3, c4, c5, c6, c7] = SERIES;
    let series = c4 + square * (c5 + square * (c6 + square * c7));
    let series = c0 + square * (c1 + square * (c2 + square * (c3 + square * series)));
    let log = exponent + t * series;
    if x == f64::INFINITY { x } else { log }
}

/// `2^x`: 0 below -1000, infinity from 1024 on.
#[inline(always)]
pub(super) fn exp2(x: f64) -> f64 {
    // 1.5 * 2^52: adding it rounds to an integer, which is then in its lowest bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    // ln(2)^k / k!
    const SERIES: [f64; 12] = [
        1.0,
        std::f64::consts::LN_2,
        0.240_226_506_959_100_7,
        0.055_504_108_664_821_58,
        0.009_618_129_107_628_477,
        0.001_333_355_814_642_844_3,
        0.000_154_035_303_933_816_1,
        0.000_015_252_733_804_059_84,
        0.000_001_321_548_679_014_431,
        0.000_000_101_780_860_092_396_99,
        0.000_000_007_054_911_620_801_123,
        0.000_000_000_444_553_827_187_081_2,
    ];
    let (small, large) = (x < -1000.0, x >= 1024.0);
    let inside = if small | large { 0.0 } else { x };
    let shifted = inside + ROUND;
    let rest = inside - (shifted - ROUND);
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11] = SERIES;
    let series = c8 + rest * (c9 + rest * (c10 + rest * c11));
    let series = c4 + rest * (c5 + rest * (c6 + rest * (c7 + rest * series)));
    let series = c0 + rest * (c1 + rest * (c2 + rest * (c3 + rest * series)));
    let power = f64::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << 52));
    let power = if large { f64::INFINITY } else { power };
    if small { 0.0 } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(found: f64, exact: f64, of: f64) {
        assert!((found - exact).abs() <= MISSED * exact.abs(), "of {of:e}: {found:e}, {exact:e}");
    }

    #[test]
    fn powers_of_two_are_those_of_the_library() {
        for step in -300_000..=300_000 {
            let x = f64::from(step) * 1.001e-3;
            assert_near(exp2(x), x.exp2(), x);
            assert_near(exp2(x * 1e-3), (x * 1e-3).exp2(), x * 1e-3);
        }
        for whole in -1000..1024 {
            assert_eq!(exp2(f64::from(whole)), f64::from(whole).exp2());
        }
        let ends = [f64::NEG_INFINITY, -1e30, 1024.0, f64::INFINITY].map(exp2);
        assert_eq!(ends, [0.0, 0.0, f64::INFINITY, f64::INFINITY]);
    }

    #[test]
    fn logarithms_are_those_of_the_library() {
        for step in 1..=400_000 {
            let x = f64::from(step) * 1.1e-5;
            assert_near(log2(x), x.log2(), x);
            let near_one = 1.0 + (f64::from(step) - 200_000.0) * 1e-9;
            assert_near(log2(near_one), (near_one - 1.0).ln_1p() / std::f64::consts::LN_2, near_one);
            let any_size = (f64::from(step) * 6.4e-4 - 126.0).exp2();
            assert_near(log2(any_size), any_size.log2(), any_size);
        }
        assert_eq!([1.0, 2.0, 0.25, f64::INFINITY].map(log2), [0.0, 1.0, -2.0, f64::INFINITY]);
    }
}
