//! Known values, and agreement with f64.

use super::{BITS, Big, Class, TO_EVEN};
use crate::domain::Number;
use astro_float_num::{BigFloat, Consts, Radix};
use proptest::prelude::*;

/// The number that a text of many digits names.
fn read(text: &str) -> Big {
    let mut constants = Consts::new().expect("memory");
    Big::rounded(&BigFloat::parse(text, Radix::Dec, BITS + 64, TO_EVEN, &mut constants))
}

fn of(value: f64) -> Big {
    Big::from_f64(value)
}

/// The difference in units of the last of 192 bits.
fn ulps(found: Big, expected: Big) -> f64 {
    let step = 2f64.powi(-(BITS as i32));
    (found.sub(expected).div(expected).value() / step).abs()
}

#[track_caller]
fn near(found: Big, text: &str) {
    let expected = read(text);
    // The texts have 60 digits, which are 199 bits.
    assert!(ulps(found, expected) < 4.0, "{:e} for {text}: {} ulp", found.value(), ulps(found, expected));
}

#[test]
fn functions_have_all_digits() {
    near(of(1e22).sin(), "-0.85220084976718880177270589375302936826176215041004365625650933");
    near(of(1e22).cos(), "0.52321478539513894549759447338470949214091997243938795352721139");
    near(of(2f64.powi(1000)).sin(), "-0.15920170308624243824004863082083903381368689877746501536751086");
    near(of(1e5).tan(), "-0.035771662952898773411330544568930962037775894919868049796478798");
    near(of(0.999).pow(of(10_000.0)), "0.000045173345977048244513929033372942328913595654929409932088120154");
    near(
        of(1.0).add(of(2f64.powi(-40))).acosh(),
        "0.0000013486991523485067976218947732603534909053916260088125402054742",
    );
    near(of(1.0).sub(of(2f64.powi(-50))).atanh(), "17.675253104278605168094814172152145097392343494770011388038627");
    near(of(2f64.powi(-40)).asinh(), "0.00000000000090949470177292823791503893711393591228933248333481603557504499");
    near(of(1.0).exp(), "2.71828182845904523536028747135266249775724709369995957496696763");
    near(of(2.0).log(), "0.693147180559945309417232121458176568075500134360255254120680009");
    near(of(1.0).atan().mul(of(4.0)), "3.14159265358979323846264338327950288419716939937510582097494459");
    near(of(-1.0).acos(), "3.14159265358979323846264338327950288419716939937510582097494459");
    near(of(2.0).sqrt(), "1.41421356237309504880168872420969807856967187537694807317667974");
    near(of(180.0).radians(), "3.14159265358979323846264338327950288419716939937510582097494459");
}

#[test]
fn digits_beyond_f64_are_kept() {
    let tiny = of(1e-20);
    assert_eq!(of(1.0).add(tiny).sub(of(1.0)).value(), 1e-20);
    assert_eq!(1.0 + 1e-20 - 1.0, 0.0);
    assert_eq!(of(1.0).add(tiny).value(), 1.0);
    assert_eq!(of(1.0).add(tiny).second(), 1e-20, "what the f64 has rounded away");
    // What is left of functions that are nearly their argument.
    let left = of(2f64.powi(-60)).sinh().sub(of(2f64.powi(-60))).div(of(2f64.powi(-180)));
    assert!((left.value() - 1.0 / 6.0).abs() < 1e-16, "{}", left.value());
    let left = of(1.0).add(of(2f64.powi(-80))).log().sub(of(2f64.powi(-80))).div(of(2f64.powi(-161)));
    assert!((left.value() + 1.0).abs() < 1e-9, "{}", left.value());
}

#[test]
fn rumps_polynomial_has_its_negative_value() {
    // 333.75 b^6 + a^2 (11 a^2 b^2 - b^6 - 121 b^4 - 2) + 5.5 b^8 + a / (2 b): f64 says 1.17 and more.
    let (a, b) = (of(77_617.0), of(33_096.0));
    let squares = (a.mul(a), b.mul(b));
    let (a2, b2) = squares;
    let b4 = b2.mul(b2);
    let (b6, b8) = (b4.mul(b2), b4.mul(b4));
    let inner = of(11.0).mul(a2).mul(b2).sub(b6).sub(of(121.0).mul(b4)).sub(of(2.0));
    let polynomial = of(333.75).mul(b6).add(a2.mul(inner)).add(of(5.5).mul(b8)).add(a.div(b.mul(of(2.0))));
    assert!((polynomial.value() + 0.827_396_059_946_821_4).abs() < 1e-15, "{}", polynomial.value());
}

#[test]
fn exact_results_are_exact() {
    assert_eq!(of(2.0).pow(of(10.0)).sub(of(1024.0)).value(), 0.0);
    near(of(3.0).pow(of(40.0)), "12157665459056928801");
    assert_eq!(of(8.0).log2().value(), 3.0);
    assert_eq!(of(0.25).log2().value(), -2.0);
    assert_eq!(of(-3.0).exp2().value(), 0.125);
    assert_eq!(of(0.0).exp().value(), 1.0);
    assert_eq!(of(1.0).log().class, Class::Zero);
    assert_eq!(of(1.0).acos().class, Class::Zero);
    assert_eq!(of(16.0).inversesqrt().value(), 0.25);
}

#[test]
fn round_trips_hold_to_the_last_bits() {
    for value in [0.1, 0.7, 1.5, 3.25, 100.0, 1e-10, 700.0] {
        let x = of(value);
        assert!(ulps(x.exp().log(), x) < 16.0 + 4.0 / value, "{value}");
        assert!(ulps(x.sqrt().square(), x) < 4.0, "{value}");
        assert!(ulps(x.sinh().asinh(), x) < 4000.0, "{value}");
        assert!(ulps(x.atan().tan(), x) < 4000.0 * (1.0 + value), "{value}");
    }
}

#[test]
fn the_range_is_that_of_binary128() {
    let large = of(f64::MAX);
    assert!(large.mul(large).class == Class::Finite && large.mul(large).value() == f64::INFINITY);
    assert_eq!(large.mul(large).div(large).value(), f64::MAX);
    assert_eq!(of(1e5).exp().class, Class::Infinite);
    assert_eq!(of(-1e5).exp().class, Class::Zero);
    assert_eq!(of(1e300).sinh().value(), f64::INFINITY);
    assert_eq!(of(-1e300).sinh().value(), f64::NEG_INFINITY);
    assert_eq!(of(1e300).tanh().value(), 1.0);
    assert_eq!(of(1e300).asinh().value(), 1e300f64.asinh());
}

/// The functions of one number, for [`of_one`].
type Pair = (&'static str, fn(Big) -> Big, fn(f64) -> f64);

fn pairs() -> Vec<Pair> {
    macro_rules! all {
        ($($name:ident)*) => { vec![$((stringify!($name), <Big as Number>::$name, <f64 as Number>::$name)),*] };
    }
    all! {
        neg abs sign floor ceil trunc round fract sqrt inversesqrt exp log exp2 log2 sin cos tan asin acos atan sinh cosh
        tanh asinh acosh atanh radians degrees
    }
}

/// Whether two f64 differ by a few roundings, relative to `scale`, if not to themselves.
fn close(a: f64, b: f64, scale: f64) -> bool {
    a == b
        || (a.is_nan() && b.is_nan())
        || (a - b).abs() <= 8.0 * f64::EPSILON * a.abs().max(b.abs()).max(scale) + f64::MIN_POSITIVE
}

#[test]
fn functions_agree_with_f64_at_edges() {
    let edges = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        -0.5,
        1.5,
        2.5,
        -2.5,
        2.0,
        3.0,
        1e-3,
        1e10,
        -1e10,
        1e22,
        1e-300,
        5e-324,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        0.1,
        710.0,
        -745.0,
        16_777_217.0,
        4_503_599_627_370_497.5,
    ];
    for (name, big, double) in pairs() {
        for x in edges {
            let (found, expected) = (big(of(x)).value(), double(x));
            assert!(close(found, expected, 0.0), "{name}({x:e}) is {found:e}, not {expected:e}");
        }
    }
    for x in edges {
        for y in edges {
            let binary: [(&str, f64, f64); 7] = [
                ("add", of(x).add(of(y)).value(), x + y),
                ("mul", of(x).mul(of(y)).value(), x * y),
                ("div", of(x).div(of(y)).value(), x / y),
                ("min", of(x).min(of(y)).value(), Number::min(x, y)),
                ("max", of(x).max(of(y)).value(), Number::max(x, y)),
                ("atan2", of(x).atan2(of(y)).value(), x.atan2(y)),
                ("pow", of(x).pow(of(y)).value(), Number::pow(x, y)),
            ];
            for (name, found, expected) in binary {
                assert!(close(found, expected, 0.0), "{name}({x:e}, {y:e}) is {found:e}, not {expected:e}");
            }
            assert_eq!(of(x).less(of(y)), u32::from(x < y), "{x} {y}");
            assert_eq!(of(x).less_equal(of(y)), u32::from(x <= y), "{x} {y}");
            assert_eq!(of(x).equal(of(y)), u32::from(x == y), "{x} {y}");
        }
        assert_eq!((of(x).to_int(), of(x).to_uint()), (x as i32 as u32, x as u32), "{x}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn arithmetic_is_f64s_rounded(x in any::<f64>(), y in any::<f64>()) {
        prop_assert_eq!(of(x).value().to_bits(), (if x.is_nan() { f64::NAN } else { x }).to_bits());
        for (found, expected) in [(of(x).add(of(y)), x + y), (of(x).sub(of(y)), x - y), (of(x).mul(of(y)), x * y), (of(x).div(of(y)), x / y)] {
            prop_assert!(found.value() == expected || expected.is_nan() && found.value().is_nan(), "{} {}", found.value(), expected);
        }
        prop_assert!(close(of(x).sqrt().value(), x.sqrt(), 0.0));
    }

    #[test]
    fn functions_are_f64s_nearly(x in -30.0f64..30.0, y in 0.0f64..30.0) {
        for (name, big, double) in pairs() {
            prop_assert!(close(big(of(x)).value(), double(x), 0.0), "{} of {}", name, x);
        }
        prop_assert!(close(of(y).pow(of(x)).value(), y.powf(x), 0.0));
        prop_assert!(close(of(x).atan2(of(y)).value(), x.atan2(y), 0.0));
    }
}
