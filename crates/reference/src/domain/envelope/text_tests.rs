//! The rules against the specifications' texts, read once more: legal results of random arguments lie in the envelope.
//!
//! *In:* Vulkan's tables (appendix "Vulkan Environment for SPIR-V", Precision and Operation) and WGSL's (Accuracy of
//! Built-in Functions), as functions of exact numbers and of how far a GPU goes. *Out:* nothing outside. *Holds:* nothing
//! here is shared with the envelope: not its ULP, its formulas or its rounding.

use super::EnvelopeFloat;
use crate::domain::Number;
use glisten_scene::picture::Interval;

/// How a GPU uses its freedom: to which end, for each step of a formula.
struct Gpu(u64);

impl Gpu {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn unit(&mut self) -> f64 {
        (self.next() % (1 << 24)) as f64 / (1 << 24) as f64
    }

    /// An f32 at most `error` away from an exact result, most often at an end.
    fn within(&mut self, exact: f64, error: f64) -> f64 {
        let goal = match self.next() % 3 {
            0 => exact - error,
            1 => exact + error,
            _ => exact + error * (2.0 * self.unit() - 1.0),
        };
        let (low, high) = neighbors(goal);
        let toward = if goal > exact { low } else { high };
        if (toward - exact).abs() <= error { toward } else { neighbors(exact).0.max(exact - error.max(one_ulp(exact))) }
    }

    /// "Correctly rounded": either of the two neighbors.
    fn rounded(&mut self, exact: f64) -> f64 {
        let (low, high) = neighbors(exact);
        if self.next().is_multiple_of(2) { low } else { high }
    }

    fn ulps(&mut self, exact: f64, n: f64) -> f64 {
        self.within(exact, n * one_ulp(exact))
    }

    fn inversesqrt(&mut self, x: f64) -> f64 {
        self.ulps(1.0 / x.sqrt(), 2.0)
    }

    fn divided(&mut self, x: f64, y: f64) -> f64 {
        self.ulps(x / y, 2.5)
    }

    fn exp(&mut self, x: f64) -> f64 {
        self.ulps(x.exp(), 3.0 + 2.0 * x.abs())
    }

    fn exp2(&mut self, x: f64) -> f64 {
        self.ulps(x.exp2(), 3.0 + 2.0 * x.abs())
    }

    fn log2(&mut self, x: f64) -> f64 {
        let exact = x.log2();
        let error =
            if (0.5..=2.0).contains(&x) { 2f64.powi(-21).max(3.0 * one_ulp(exact)) } else { 3.0 * one_ulp(exact) };
        self.within(exact, error)
    }

    fn log(&mut self, x: f64) -> f64 {
        let exact = x.ln();
        let error =
            if (0.5..=2.0).contains(&x) { 2f64.powi(-21).max(3.0 * one_ulp(exact)) } else { 3.0 * one_ulp(exact) };
        self.within(exact, error)
    }

    fn sin(&mut self, x: f64) -> f64 {
        self.within(x.sin(), 2f64.powi(-11))
    }

    fn cos(&mut self, x: f64) -> f64 {
        self.within(x.cos(), 2f64.powi(-11))
    }

    /// "Inherited": as far from the exact result as the formula is, to either side.
    fn inherited(&mut self, exact: f64, by_formula: f64) -> f64 {
        let mirrored = neighbors(2.0 * exact - by_formula);
        let inward = if by_formula > exact { mirrored.1 } else { mirrored.0 };
        if self.next().is_multiple_of(2) { by_formula } else { inward }
    }
}

/// The f32 numbers around a number.
fn neighbors(x: f64) -> (f64, f64) {
    let near = x as f32;
    let value = f64::from(near);
    if value == x || !value.is_finite() {
        (value, value)
    } else if value > x {
        (f64::from(near.next_down()), value)
    } else {
        (value, f64::from(near.next_up()))
    }
}

/// Vulkan's ULP: the distance of the f32 numbers around an exact result.
fn one_ulp(x: f64) -> f64 {
    let (low, high) = neighbors(x);
    if low < high { high - low } else { f64::from((x.abs() as f32).next_up()) - x.abs() }
}

/// A function of up to three arguments, its domain, and what a GPU may return.
struct Text {
    name: &'static str,
    low: f64,
    high: f64,
    envelope: fn([EnvelopeFloat; 3]) -> EnvelopeFloat,
    gpu: fn(&mut Gpu, [f64; 3]) -> f64,
}

const TEXTS: &[Text] = &[
    Text {
        name: "a + b",
        low: -8.0,
        high: 8.0,
        envelope: |[a, b, _]| a.add(b),
        gpu: |gpu, [a, b, _]| gpu.rounded(a + b),
    },
    Text {
        name: "a b",
        low: -8.0,
        high: 8.0,
        envelope: |[a, b, _]| a.mul(b),
        gpu: |gpu, [a, b, _]| gpu.rounded(a * b),
    },
    Text {
        name: "a b + c",
        low: -8.0,
        high: 8.0,
        envelope: |[a, b, c]| a.mul(b).add(c),
        gpu: |gpu, [a, b, c]| {
            let fused = gpu.next() % 2 == 0;
            let product = if fused { a * b } else { gpu.rounded(a * b) };
            gpu.rounded(product + c)
        },
    },
    Text {
        name: "a / b",
        low: 0.01,
        high: 900.0,
        envelope: |[a, b, _]| a.div(b),
        gpu: |gpu, [a, b, _]| match b.log2() {
            whole if whole == whole.floor() => gpu.rounded(a / b),
            _ => gpu.divided(a, b),
        },
    },
    Text {
        name: "a / b by the letter",
        low: 0.01,
        high: 900.0,
        envelope: |[a, b, _]| a.div(b).loosened(b),
        gpu: |gpu, [a, b, _]| gpu.divided(a, b),
    },
    Text {
        name: "inversesqrt",
        low: 1e-9,
        high: 1e9,
        envelope: |[x, ..]| x.inversesqrt(),
        gpu: |gpu, [x, ..]| gpu.inversesqrt(x),
    },
    Text {
        name: "sqrt",
        low: 1e-9,
        high: 1e9,
        envelope: |[x, ..]| x.sqrt(),
        gpu: |gpu, [x, ..]| {
            let inner = gpu.inversesqrt(x);
            let by_formula = gpu.divided(1.0, inner);
            gpu.inherited(x.sqrt(), by_formula)
        },
    },
    Text { name: "exp", low: -20.0, high: 20.0, envelope: |[x, ..]| x.exp(), gpu: |gpu, [x, ..]| gpu.exp(x) },
    Text { name: "exp2", low: -20.0, high: 20.0, envelope: |[x, ..]| x.exp2(), gpu: |gpu, [x, ..]| gpu.exp2(x) },
    Text { name: "log", low: 1e-6, high: 1e6, envelope: |[x, ..]| x.log(), gpu: |gpu, [x, ..]| gpu.log(x) },
    Text { name: "log2", low: 1e-6, high: 1e6, envelope: |[x, ..]| x.log2(), gpu: |gpu, [x, ..]| gpu.log2(x) },
    Text {
        name: "pow",
        low: 0.01,
        high: 12.0,
        envelope: |[x, y, _]| x.pow(y),
        gpu: |gpu, [x, y, _]| {
            let logarithm = gpu.log2(x);
            let product = gpu.rounded(y * logarithm);
            let by_formula = gpu.exp2(product);
            gpu.inherited(x.powf(y), by_formula)
        },
    },
    Text { name: "sin", low: -3.1, high: 3.1, envelope: |[x, ..]| x.sin(), gpu: |gpu, [x, ..]| gpu.sin(x) },
    Text { name: "cos", low: -3.1, high: 3.1, envelope: |[x, ..]| x.cos(), gpu: |gpu, [x, ..]| gpu.cos(x) },
    Text {
        name: "tan",
        low: -1.4,
        high: 1.4,
        envelope: |[x, ..]| x.tan(),
        gpu: |gpu, [x, ..]| {
            let (sine, cosine) = (gpu.sin(x), gpu.cos(x));
            gpu.divided(sine, cosine)
        },
    },
    Text {
        name: "atan",
        low: -50.0,
        high: 50.0,
        envelope: |[x, ..]| x.atan(),
        gpu: |gpu, [x, ..]| gpu.ulps(x.atan(), 4096.0),
    },
    Text {
        name: "asin",
        low: -1.0,
        high: 1.0,
        envelope: |[x, ..]| x.asin(),
        gpu: |gpu, [x, ..]| gpu.within(x.asin(), 6.81e-5),
    },
    Text {
        name: "acos",
        low: -1.0,
        high: 1.0,
        envelope: |[x, ..]| x.acos(),
        gpu: |gpu, [x, ..]| gpu.within(x.acos(), 6.77e-5),
    },
    Text {
        name: "sinh",
        low: -9.0,
        high: 9.0,
        envelope: |[x, ..]| x.sinh(),
        gpu: |gpu, [x, ..]| {
            let (up, down) = (gpu.exp(x), gpu.exp(-x));
            let difference = gpu.rounded(up - down);
            gpu.inherited(x.sinh(), difference * 0.5)
        },
    },
    Text {
        name: "cosh",
        low: -9.0,
        high: 9.0,
        envelope: |[x, ..]| x.cosh(),
        gpu: |gpu, [x, ..]| {
            let (up, down) = (gpu.exp(x), gpu.exp(-x));
            let sum = gpu.rounded(up + down);
            gpu.inherited(x.cosh(), sum * 0.5)
        },
    },
    Text {
        name: "tanh",
        low: -9.0,
        high: 9.0,
        envelope: |[x, ..]| x.tanh(),
        gpu: |gpu, [x, ..]| gpu.within(x.tanh(), 1e-5),
    },
    Text {
        name: "mod",
        low: 1e-4,
        high: 4e6,
        envelope: |[x, y, _]| x.modulo(y),
        gpu: |gpu, [x, y, _]| {
            let quotient = if y.log2() == y.log2().floor() { gpu.rounded(x / y) } else { gpu.divided(x, y) };
            let product = gpu.rounded(y * quotient.floor());
            gpu.rounded(x - product)
        },
    },
    Text {
        name: "mix",
        low: -5.0,
        high: 5.0,
        envelope: |[x, y, a]| x.mix(y, a),
        gpu: |gpu, [x, y, a]| {
            if gpu.next() % 2 == 0 {
                let rest = gpu.rounded(1.0 - a);
                let (left, right) = (gpu.rounded(x * rest), gpu.rounded(y * a));
                gpu.rounded(left + right)
            } else {
                let gap = gpu.rounded(y - x);
                let step = gpu.rounded(gap * a);
                gpu.rounded(x + step)
            }
        },
    },
    Text {
        name: "smoothstep(-1, 2, x)",
        low: -3.0,
        high: 4.0,
        envelope: |[x, ..]| EnvelopeFloat::smoothstep(EnvelopeFloat::from_f64(-1.0), EnvelopeFloat::from_f64(2.0), x),
        gpu: |gpu, [x, ..]| {
            let above = gpu.rounded(x + 1.0);
            let t = gpu.divided(above, 3.0).clamp(0.0, 1.0);
            let square = gpu.rounded(t * t);
            let twice = gpu.rounded(3.0 - t * 2.0);
            gpu.rounded(square * twice)
        },
    },
    Text {
        name: "a component of normalize, by Vulkan and by WGSL",
        low: -6.0,
        high: 6.0,
        envelope: |v| {
            let squares = EnvelopeFloat::sum(v.iter().map(|x| x.square()));
            v[0].scaled(squares.unit_scale()).cosine_at_most()
        },
        gpu: |gpu, v| {
            let squares = v.map(|x| gpu.rounded(x * x));
            let first = gpu.rounded(squares[0] + squares[1]);
            let sum = gpu.rounded(first + squares[2]);
            let inverse = gpu.inversesqrt(sum);
            if gpu.next() % 2 == 0 {
                return gpu.rounded(v[0] * inverse);
            }
            let length = gpu.divided(1.0, inverse);
            gpu.divided(v[0], length)
        },
    },
];

/// An interval of f32 numbers in a range: a point, a few ULP, or wide, now and then with a power of two inside.
fn interval(gpu: &mut Gpu, low: f64, high: f64) -> (f64, f64) {
    let pick = |gpu: &mut Gpu| {
        let value = match gpu.next() % 4 {
            0 if low > 0.0 => (low.log2() + (high / low).log2() * gpu.unit()).exp2(),
            1 => (gpu.next() % 24) as f64 - 12.0,
            _ => low + (high - low) * gpu.unit(),
        };
        f64::from((value as f32).clamp(low as f32, high as f32))
    };
    let a = pick(gpu);
    let b = match gpu.next() % 3 {
        0 => a,
        1 => f64::from((a * (1.0 + gpu.unit() * 1e-5)) as f32).clamp(low, high),
        _ => pick(gpu),
    };
    let grid = |x: f64| f64::from(x as f32);
    (grid(a.min(b)), grid(a.max(b)))
}

#[test]
fn what_the_texts_allow_lies_in_the_envelope() {
    for (number, text) in TEXTS.iter().enumerate() {
        let mut gpu = Gpu(number as u64 + 17);
        for _ in 0..6000 {
            let ends = [0, 1, 2].map(|_| interval(&mut gpu, text.low, text.high));
            let point = ends.map(|(low, high)| match gpu.next() % 3 {
                0 => low,
                1 => high,
                _ => f64::from((low + (high - low) * gpu.unit()) as f32).clamp(low, high),
            });
            let arguments: [EnvelopeFloat; 3] = std::array::from_fn(|k| {
                let (low, high) = ends[k];
                EnvelopeFloat::with_interval(point[k], Interval { low, high, may_be_nan: false })
            });
            let legal = (text.gpu)(&mut gpu, point);
            let found = (text.envelope)(arguments);
            assert!(
                legal.is_nan() || found.interval().contains(legal) || legal.abs() < f64::from(f32::MIN_POSITIVE),
                "{} of {point:?} in {ends:?}: {legal:e} is legal, and not in {found:?}",
                text.name
            );
        }
    }
}
