//! Numbers and sentences of the page.
//!
//! *In:* figures. *Out:* text for people. *Holds:* a number that is not finite is written as such.

use super::super::{Findings, Stability};
use glisten_page::words::{grouped, scientific};
use minijinja::HtmlEscape;

/// A figure with three digits: plain from 0.01 to 10,000, with a power of ten otherwise.
pub(super) fn number(value: f64) -> String {
    match value.abs() {
        size if !size.is_finite() => "not finite".to_owned(),
        0.0 => "0".to_owned(),
        size if (0.01..10_000.0).contains(&size) => {
            let digits = (2 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{value:.digits$}");
            let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            text.replace('-', "\u{2212}")
        }
        size => format!("{}{}", if value < 0.0 { "\u{2212}" } else { "" }, scientific(size)),
    }
}

/// A channel of a color, or a component of an input, with the digits in which f32 and exact arithmetic may differ.
pub(super) fn channel(value: Option<f64>) -> String {
    match value {
        None => "not finite".to_owned(),
        Some(value) if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) => format!("{value:.5e}"),
        Some(value) => format!("{value:.6}"),
    }
}

/// The value of an input, with six digits.
pub(super) fn value(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// Several channels.
pub(super) fn channels(values: &[Option<f64>]) -> String {
    values.iter().copied().map(channel).collect::<Vec<_>>().join(", ")
}

/// A path as HTML, which may break after each folder.
pub(super) fn path(name: &str) -> String {
    let parts: Vec<String> = name.split('/').map(|part| HtmlEscape(part).to_string()).collect();
    parts.join("/<wbr>")
}

/// A help text as HTML: what stands between backticks is code.
pub(super) fn help(text: &str) -> String {
    let escaped = |part: &str| HtmlEscape(part).to_string();
    let parts = text.split('`').enumerate();
    parts
        .map(|(at, part)| if at % 2 == 1 { format!("<code>{}</code>", escaped(part)) } else { escaped(part) })
        .collect()
}

/// A count of things.
pub(super) fn count(count: u64, one: &str, many: &str) -> String {
    format!("{} {}", grouped(count), if count == 1 { one } else { many })
}

/// How often the bound goes into an error, or the other way round.
fn against(error: f64, bound: f64) -> String {
    match error / bound {
        ratio if ratio > 1.0 => format!("{} times the accepted {}", number(rounded(ratio)), number(bound)),
        ratio => format!("{} of the accepted {}", percent(ratio), number(bound)),
    }
}

/// Two digits are enough for a ratio.
fn rounded(ratio: f64) -> f64 {
    if ratio < 10.0 { (ratio * 10.0).round() / 10.0 } else { ratio.round() }
}

fn percent(ratio: f64) -> String {
    match ratio * 100.0 {
        share if share < 0.1 => "less than 0.1 %".to_owned(),
        share if share < 10.0 => format!("{share:.1} %"),
        share => format!("{share:.0} %"),
    }
}

/// The verdict with its figures, in a sentence or two.
pub(super) fn verdict(findings: &Findings, verdict: Stability, bound: f64, pixels: u64) -> String {
    let picture = &findings.picture;
    let error = match picture.max_abs {
        0.0 if pixels > 0 => "where the picture is finite, it has no error".to_owned(),
        0.0 => "it has no error".to_owned(),
        error => format!(
            "the largest {}error is {} ({}), the root mean square {}",
            if pixels > 0 { "finite " } else { "" },
            number(error),
            against(error, bound),
            number(picture.rmse)
        ),
    };
    let finite = match (pixels, findings.non_finite) {
        (0, 0) => "every result is finite".to_owned(),
        (0, births) => {
            let births = count(births, "result is", "results are");
            format!("{births} not finite, and no pixel shows it")
        }
        (pixels, _) => format!("{} not finite", count(pixels, "pixel is", "pixels are")),
    };
    let opening = match verdict {
        Stability::Stable => "f32 arithmetic does no harm to this picture",
        Stability::Degraded => "f32 arithmetic is too coarse for this picture",
        Stability::Broken if pixels > 0 => "f32 arithmetic breaks this picture",
        Stability::Broken if findings.causes.iter().any(|cause| cause.undefined.is_some()) => {
            "the picture depends on what GLSL leaves undefined"
        }
        Stability::Broken => "f32 arithmetic decides differently than exact arithmetic, and the picture shows it",
    };
    format!("{opening}: {error}; {finite}.")
}

#[cfg(test)]
mod tests {
    use super::{against, channel, help, number, path, value};

    #[test]
    fn figures_have_three_digits() {
        let table = [
            (0.0, "0"),
            (0.138_04, "0.138"),
            (1.5, "1.5"),
            (141.4, "141"),
            (-0.5, "\u{2212}0.5"),
            (f64::INFINITY, "not finite"),
            (1e-9, "1.0\u{202f}\u{d7}\u{202f}10\u{207b}\u{2079}"),
        ];
        for (value, text) in table {
            assert_eq!(number(value), text, "{value}");
        }
        assert_eq!(channel(Some(1e-7)), "1.00000e-7");
        assert_eq!(channel(Some(-0.25)), "-0.250000");
        assert_eq!([0.1 + 0.2, 1e300 / 3.0, -20.0, 0.0].map(value), ["0.3", "3.33333e299", "-20", "0"]);
        assert_eq!(help("a < `b & c`"), "a &lt; <code>b &amp; c</code>");
        assert_eq!(path("a/<b>"), "a/<wbr>&lt;b&gt;");
        assert_eq!(against(2.0, 1.0), "2 times the accepted 1");
    }
}
