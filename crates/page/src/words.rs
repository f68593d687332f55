//! Figures as people write them.
//!
//! *In:* numbers. *Out:* short texts with typographic characters. *Holds:* a figure that there is not is a dash; what the
//! reader is to compare has as many digits in every row.

/// The place of a figure that there is not.
pub const NONE: &str = "\u{2013}";

/// `1.2e-3` as `1.2 x 10^-3` in typographic characters; 0 as 0.
pub fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let text = format!("{value:.1e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let raised: String = exponent
        .chars()
        .filter_map(|sign| match sign {
            '-' => Some('\u{207b}'),
            '1' => Some('\u{b9}'),
            '2' => Some('\u{b2}'),
            '3' => Some('\u{b3}'),
            digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)),
        })
        .collect();
    format!("{mantissa}\u{202f}\u{d7}\u{202f}10{raised}")
}

/// The digits in groups of three.
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A figure with this many digits after the point.
pub fn fixed(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { NONE.into() }
}

/// An interval: `0.98 - 1.02`.
pub fn interval([low, high]: [f64; 2]) -> String {
    if low.is_finite() && high.is_finite() { format!("{low:.2}\u{2013}{high:.2}") } else { NONE.into() }
}

/// A share of 1 in percent.
pub fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.1}\u{202f}%", share * 100.0) } else { NONE.into() }
}

/// The segments and rings of a mesh.
pub fn mesh(tessellation: Option<[u32; 2]>) -> Option<String> {
    tessellation.map(|[segments, rings]| format!("{segments}\u{202f}\u{d7}\u{202f}{rings}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people() {
        assert_eq!(scientific(1.25e-13), "1.2\u{202f}\u{d7}\u{202f}10\u{207b}\u{b9}\u{b3}");
        assert_eq!(scientific(0.0), "0");
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(grouped(12), "12");
        assert_eq!(fixed(1.0, 2), "1.00");
        assert_eq!([fixed(f64::NAN, 2), interval([f64::NAN, 1.0])], [NONE, NONE]);
        assert_eq!(interval([0.5, 1.254]), "0.50\u{2013}1.25");
        assert_eq!(percent(0.031), "3.1\u{202f}%");
        assert_eq!(mesh(Some([16, 8])).as_deref(), Some("16\u{202f}\u{d7}\u{202f}8"));
    }
}
