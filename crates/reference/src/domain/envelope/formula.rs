//! Evaluates rules of precision over envelopes.
//!
//! *In:* a [`Rule`] of the front end's table, and intervals of arguments. *Out:* the interval that the rule allows.
//! *Holds:* a formula is evaluated operation by operation, each by its own rule. *Not done here:* functions that are
//! not monotonic and do not inherit from a formula ([`functions`](super::functions)), and the kernels that evaluate
//! the formulas of the most frequent functions in a faster way. These check with [`Rule::inherits`] that the formula
//! is still theirs.

use super::EnvelopeFloat;
use super::round::{ulps_above, ulps_below};
use crate::domain::Number;
use glisten_front::builtin::operations::{Binary, Formula, Precision, Rule, Unary};

/// The value of a formula at a component of vectors of arguments. Scalars are combined with every component.
pub(crate) fn evaluate<N: Number>(formula: &Formula, arguments: &[&[N]], component: usize) -> N {
    let of = |part: &Formula| evaluate(part, arguments, component);
    let size = || arguments.iter().map(|argument| argument.len()).max().unwrap_or(1);
    match formula {
        Formula::Argument(number) => {
            let values = arguments.get(usize::from(*number)).copied().unwrap_or(&[]);
            let place = if values.len() == 1 { 0 } else { component };
            values.get(place).copied().unwrap_or(N::from_f64(f64::NAN))
        }
        Formula::Constant(value) => N::from_f64(*value),
        Formula::Unary(op, a) => unary(*op, of(a)),
        Formula::Binary(Binary::Mul, a, b) if a.same(b) => of(a).square(),
        Formula::Binary(op, a, b) => binary(*op, of(a), of(b)),
        Formula::Dot(a, b) => {
            let term = |place: usize| {
                let left = evaluate(a, arguments, place);
                if a.same(b) { left.square() } else { left.mul(evaluate(b, arguments, place)) }
            };
            N::sum((0..size()).map(term))
        }
        Formula::Next(places, a) => evaluate(a, arguments, (component + usize::from(*places)) % size()),
        Formula::IfLess([a, b, yes, no]) => N::select(of(a).less(of(b)), of(yes), of(no)),
        Formula::Either(a, b) => of(a).joined(of(b)),
        Formula::With(outer, t) => evaluate(outer, &[&[of(t)]], 0),
    }
}

pub(crate) fn unary<N: Number>(op: Unary, x: N) -> N {
    let scaled = |factor: f64| N::narrow(x.widen().mul(N::Wide::from_f64(factor)));
    match op {
        Unary::Neg => x.neg(),
        Unary::Abs => x.abs(),
        Unary::Sign => x.sign(),
        Unary::Floor => x.floor(),
        Unary::Ceil => x.ceil(),
        Unary::Trunc => x.trunc(),
        Unary::Round => x.round(),
        Unary::Fract => x.fract(),
        Unary::Sqrt => x.sqrt(),
        Unary::Inversesqrt => x.inversesqrt(),
        Unary::Exp => x.exp(),
        Unary::Log => x.log(),
        Unary::Exp2 => x.exp2(),
        Unary::Log2 => x.log2(),
        Unary::Sin => x.sin(),
        Unary::Cos => x.cos(),
        Unary::Tan => x.tan(),
        Unary::Asin => x.asin(),
        Unary::Acos => x.acos(),
        Unary::Atan => x.atan(),
        Unary::Sinh => x.sinh(),
        Unary::Cosh => x.cosh(),
        Unary::Tanh => x.tanh(),
        Unary::Asinh => x.asinh(),
        Unary::Acosh => x.acosh(),
        Unary::Atanh => x.atanh(),
        Unary::Radians => scaled(std::f64::consts::PI / 180.0),
        Unary::Degrees => scaled(180.0 / std::f64::consts::PI),
    }
}

pub(crate) fn binary<N: Number>(op: Binary, x: N, y: N) -> N {
    match op {
        Binary::Add => x.add(y),
        Binary::Sub => x.sub(y),
        Binary::Mul => x.mul(y),
        Binary::Div => x.div(y),
        Binary::Min => x.min(y),
        Binary::Max => x.max(y),
        Binary::Mod => x.modulo(y),
        Binary::Pow => x.pow(y),
        Binary::Atan2 => x.atan2(y),
        Binary::Step => N::select(y.less(x), N::from_f64(0.0), N::from_f64(1.0)),
    }
}

impl EnvelopeFloat {
    /// The interval of a rule's formula, with the exact value. If the rule has no formula, the result may be
    /// anything.
    pub(super) fn by_formula(rule: &Rule, value: f64, arguments: &[Self]) -> Self {
        let Some(formula) = rule.formula() else { return Self::anything(value) };
        match arguments {
            [x] => evaluate(formula, &[&[*x]], 0).of_value(value),
            [x, y] => evaluate(formula, &[&[*x], &[*y]], 0).of_value(value),
            [x, y, z] => evaluate(formula, &[&[*x], &[*y], &[*z]], 0).of_value(value),
            _ => Self::anything(value),
        }
    }

    /// The intervals of a rule's formula at both bounds. A rule without a formula has none that anything reads.
    pub(super) fn at_ends(self, rule: &Rule) -> [Self; 2] {
        match rule.formula() {
            Some(formula) if self.is_point() => [evaluate(formula, &[&[Self::exact(self.low)]], 0); 2],
            Some(formula) => self.bounds().map(|end| evaluate(formula, &[&[end]], 0)),
            None => [self; 2],
        }
    }

    /// A function that never decreases, by its rule.
    pub(super) fn rising_by(self, rule: &Rule, f: impl Fn(f64) -> f64) -> Self {
        self.rising_between(rule, f, self.at_ends(rule))
    }

    /// A function that never decreases, by its rule and the intervals of its formula [at both bounds](Self::at_ends).
    pub(super) fn rising_between(self, rule: &Rule, f: impl Fn(f64) -> f64, ends: [Self; 2]) -> Self {
        let (value, low, high) = (f(self.value), f(self.low), f(self.high));
        let between = |low: f64, high: f64| Self::rounded(value, low, high, self.may_be_nan);
        match rule.precision {
            Precision::Exact | Precision::EitherOfNan => Self { value, low, high, may_be_nan: self.may_be_nan },
            Precision::Correct => between(low, high),
            Precision::Ulps(n) => between(ulps_below(low, high, n), ulps_above(low, high, n)),
            Precision::UlpsWithArgument { .. } => {
                let most = rule.ulps_at(self.low).max(rule.ulps_at(self.high));
                between(ulps_below(low, high, most), ulps_above(low, high, most))
            }
            Precision::UlpsOrWithin { ulps, error, low: least, high: most } => {
                let error = if self.high >= least && self.low <= most { error } else { 0.0 };
                between(ulps_below(low, high, ulps).min(low - error), ulps_above(low, high, ulps).max(high + error))
            }
            Precision::Absolute(error) | Precision::Angle { error, .. } => between(low - error, high + error),
            Precision::Inherited(_) => self.between_ends(f, ends),
            Precision::InheritedOr(_, error) => {
                let found = self.between_ends(f, ends);
                Self { low: found.low.min(low - error), high: found.high.max(high + error), ..found }
            }
            // A half may go to either side.
            Precision::EitherHalf => Self {
                value,
                low: (self.low - 0.5).ceil(),
                high: (self.high + 0.5).floor(),
                may_be_nan: self.may_be_nan,
            },
            Precision::EitherDifference | Precision::Cofactors => Self::anything(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::rules::{self, PIPELINE};
    use glisten_front::builtin::operations::precision::RULES;

    fn of(low: f64, high: f64) -> EnvelopeFloat {
        EnvelopeFloat::rounded((low + high) / 2.0, low, high, false)
    }

    fn by(precision: Precision) -> EnvelopeFloat {
        let rule = Rule { precision, ..rules::ATAN };
        of(0.7, 0.71).rising_by(&rule, f64::atan)
    }

    /// Each kind of rule yields another interval, and so does each other number in it.
    #[test]
    fn a_changed_rule_changes_the_result() {
        const X: Formula = Formula::Argument(0);
        const SQUARE_ROOT: Formula = Formula::Unary(Unary::Sqrt, &X);
        const SINE: Formula = Formula::Unary(Unary::Sin, &X);
        let found = [
            Precision::Exact,
            Precision::Correct,
            Precision::Ulps(4.0),
            Precision::Ulps(8.0),
            Precision::UlpsWithArgument { fixed: 12.0, slope: 0.0 },
            Precision::UlpsWithArgument { fixed: 12.0, slope: 100.0 },
            Precision::UlpsOrWithin { ulps: 20.0, error: 1e-2, low: 1.0, high: 2.0 },
            Precision::UlpsOrWithin { ulps: 20.0, error: 1e-2, low: 0.0, high: 2.0 },
            Precision::Absolute(0.5),
            Precision::Angle { error: 0.25, reduced: 1.0, lost: 2.0 },
            Precision::Inherited(&SINE),
            Precision::Inherited(&SQUARE_ROOT),
            Precision::InheritedOr(&SINE, 0.125),
            Precision::EitherHalf,
            Precision::Cofactors,
        ]
        .map(|precision| (precision, by(precision)));
        for (index, (one, result)) in found.iter().enumerate() {
            for (other, different) in &found[..index] {
                assert!((result.low, result.high) != (different.low, different.high), "{one:?} is as {other:?}");
            }
        }
    }

    /// For formulas with a faster kernel, both yield intervals of the same numbers, and the kernel is in use.
    #[test]
    fn kernels_evaluate_the_formulas_of_their_rules() {
        assert!(rules::SQRT.inherits(&rules::kernels::SQRT));
        assert!(rules::POW.inherits(&rules::kernels::POW));
        assert!(rules::MIX.inherits(&rules::kernels::MIX));
        let near = |fast: EnvelopeFloat, slow: EnvelopeFloat| {
            let width = (slow.high - slow.low).max(rules::ulp(slow.high));
            let close = |a: f64, b: f64| a == b || (a - b).abs() <= width;
            assert!(close(fast.low, slow.low) && close(fast.high, slow.high), "{fast:?} {slow:?}");
            assert!(fast.high >= slow.low && fast.low <= slow.high, "{fast:?} {slow:?}");
        };
        for x in [0.01, 0.3, 1.0, 2.0, 7.5, 1e4, 3e12] {
            let argument = EnvelopeFloat::from_f64(x);
            near(argument.sqrt(), EnvelopeFloat::by_formula(&rules::SQRT, x.sqrt(), &[argument]));
            for y in [0.5, 2.0, 3.25] {
                let y = EnvelopeFloat::from_f64(y);
                let slow = EnvelopeFloat::by_formula(&rules::POW, 0.0, &[argument, y]);
                near(argument.pow(y), slow);
                let a = EnvelopeFloat::from_f64(0.3);
                near(argument.mix(y, a), EnvelopeFloat::by_formula(&rules::MIX, 0.0, &[argument, y, a]));
            }
        }
    }

    /// A formula computes its function: in f64 it yields the function's own value.
    #[test]
    fn formulas_compute_their_functions() {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs().max(1.0);
        let mut count = 0;
        for op in Unary::ALL {
            let Some(formula) = op.rule().formula() else { continue };
            let x = if *op == Unary::Acosh { 1.7 } else { 0.37 };
            assert!(close(evaluate(formula, &[&[x]], 0), op.of(x)), "{}", op.name());
            count += 1;
        }
        for op in Binary::ALL {
            let Some(formula) = op.rule().formula() else { continue };
            assert!(close(evaluate(formula, &[&[2.7], &[1.3]], 0), op.of(2.7, 1.3)), "{}", op.name());
            count += 1;
        }
        for op in glisten_front::builtin::operations::Ternary::ALL {
            let Some(formula) = op.rule().formula() else { continue };
            assert!(close(evaluate(formula, &[&[0.2], &[1.3], &[0.6]], 0), op.of(0.2, 1.3, 0.6)), "{}", op.name());
            count += 1;
        }
        assert_eq!(count, 17, "every formula of numbers");
    }

    #[test]
    fn rules_have_names_of_their_own() {
        for rule in RULES {
            assert!(PIPELINE.iter().chain(rules::OWN).all(|step| step.operation != rule.operation));
        }
    }
}
