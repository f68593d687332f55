//! [`Axis`]: a logarithmic axis of a plot as SVG.
//!
//! *In:* the values to cover, and the two ends of the axis in the plot. *Out:* places of values, and round numbers to write
//! at them. *Holds:* an axis over nothing, or over a single value, is still an axis.

/// A logarithmic axis from one end of the plot to the other.
pub struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// An axis that covers all values, with a margin on both sides.
    pub fn over(values: impl Iterator<Item = f64>, margin: f64, from: f64, to: f64) -> Self {
        let logs = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| (low.min(log), high.max(log)));
        if low > high {
            return Self { low: -1.0, high: 1.0, from, to };
        }
        let margin = margin.max((high - low) * 0.08);
        Self { low: low - margin, high: high + margin, from, to }
    }

    /// Where a value is.
    pub fn place(&self, value: f64) -> f64 {
        self.from + (value.log10() - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// Round numbers within the axis: the decades alone if there are many, otherwise few steps in each decade, at
    /// least three ticks in all.
    pub fn ticks(&self) -> Vec<f64> {
        let decades: &[f64] = &[1.0];
        let finer: [&[f64]; 3] =
            [&[1.0, 2.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0], &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]];
        if self.high - self.low > 2.5 {
            return self.multiples(decades);
        }
        let all = finer.map(|steps| self.multiples(steps));
        let enough = all.iter().position(|ticks| ticks.len() >= 3).unwrap_or(all.len() - 1);
        all.into_iter().nth(enough).unwrap_or_default()
    }

    /// These steps in every decade, within the axis.
    fn multiples(&self, steps: &[f64]) -> Vec<f64> {
        // A division where they are fractions, so that they print exactly.
        let at = |step: f64, decade: i32| {
            if decade < 0 { step / 10f64.powi(-decade) } else { step * 10f64.powi(decade) }
        };
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        decades
            .flat_map(|decade| steps.iter().map(move |step| at(*step, decade)))
            .filter(|tick| (self.low..=self.high).contains(&tick.log10()))
            .collect()
    }
}

/// The factor, to a tenth, and the exponent of a number.
pub(crate) fn parts(tick: f64) -> (f64, f64) {
    let exponent = tick.log10().floor();
    ((tick / 10f64.powf(exponent) * 10.0).round() / 10.0, exponent)
}

/// A power of `10` with its exponent raised, and a factor before it if that is not 1.
pub fn power(tick: f64) -> String {
    let (factor, exponent) = parts(tick);
    let exponent = exponent.to_string().replace('-', "\u{2212}");
    let raised = format!("10<tspan dy=\"-5\" font-size=\"9.5\">{exponent}</tspan>");
    if factor == 1.0 { raised } else { format!("{factor}\u{b7}{raised}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let narrow = Axis::over([1.0, 7.0].into_iter(), 0.06, 0.0, 1.0);
        assert_eq!(narrow.ticks(), [1.0, 2.0, 5.0]);
        let wide = Axis::over([1e-5, 1e-1].into_iter(), 0.0, 0.0, 1.0);
        assert_eq!(wide.ticks().len(), 5);
        let close = Axis::over([0.75, 1.6].into_iter(), 0.0, 0.0, 1.0);
        assert_eq!(close.ticks(), [0.8, 1.0, 1.2, 1.5]);
        assert_eq!(Axis::over([0.55, 0.95].into_iter(), 0.0, 0.0, 1.0).ticks(), [0.6, 0.8]);
        assert_eq!(power(0.0015), power(0.001).replace("10<", "1.5\u{b7}10<"));
    }

    #[test]
    fn an_axis_over_nothing_is_still_an_axis() {
        assert!(Axis::over(std::iter::empty(), 0.1, 0.0, 1.0).place(1.0).is_finite());
        assert!(Axis::over([2.0].into_iter(), 0.1, 0.0, 1.0).place(2.0).is_finite());
    }
}
