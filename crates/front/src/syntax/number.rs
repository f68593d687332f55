//! Converts numerals to values (GLSL 1.50 §4.1.3, §4.1.4).
//!
//! *In:* the spelling that the lexer read as a number. *Out:* a [`Numeral`], or the reason why it is not one.

use super::token::TokenKind;

/// The value of a numeral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Numeral {
    /// `Int`, `Uint` or `Float`.
    pub(super) kind: TokenKind,
    /// The value's bits.
    pub(super) bits: u32,
    /// A reason for a warning.
    pub(super) warning: Option<NumeralWarning>,
}

/// Why a legal numeral may not mean what its author thinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumeralWarning {
    /// A decimal without `u` above 2147483648: it becomes negative.
    Negative,
    /// A float above the largest finite one: it becomes infinite.
    Infinite,
}

/// Why a spelling is not a numeral.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Malformed {
    /// It needs more than 32 bits.
    TooLarge,
    /// `089`
    OctalDigit,
    /// `0x`, `0xu`
    NoDigits,
    /// `1e`, `1e+`
    NoExponent,
    /// The text after the digits, from this byte on, is not a suffix.
    Suffix(usize),
}

/// Converts a numeral.
pub(super) fn read(text: &str) -> Result<Numeral, Malformed> {
    if let Some(digits) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        return integer(text, digits, 16);
    }
    if text.bytes().any(|byte| matches!(byte, b'.' | b'e' | b'E')) {
        return float(text);
    }
    if matches!(text.bytes().last(), Some(b'f' | b'F')) && text.bytes().rev().skip(1).all(|byte| byte.is_ascii_digit())
    {
        // `1f`: the grammar requires a point or an exponent before the suffix.
        return Err(Malformed::Suffix(text.len() - 1));
    }
    if text.len() > 1 && text.starts_with('0') {
        return integer(text, text.get(1..).unwrap_or(""), 8);
    }
    integer(text, text, 10)
}

fn integer(text: &str, digits: &str, radix: u32) -> Result<Numeral, Malformed> {
    let prefix = text.len() - digits.len();
    let length = digits.bytes().position(|byte| !(byte as char).is_digit(radix)).unwrap_or(digits.len());
    let (number, suffix) = digits.split_at(length);
    let kind = match suffix {
        "" => TokenKind::Int,
        "u" | "U" => TokenKind::Uint,
        _ if radix == 8 && suffix.starts_with(['8', '9']) => return Err(Malformed::OctalDigit),
        _ => return Err(Malformed::Suffix(prefix + length)),
    };
    let value = if number.is_empty() {
        // `0` alone, and `0u`, are octal numbers without further digits.
        if radix == 8 { 0 } else { return Err(Malformed::NoDigits) }
    } else {
        u32::from_str_radix(number, radix).map_err(|_| Malformed::TooLarge)?
    };
    let negative = kind == TokenKind::Int && radix == 10 && value > 1 << 31;
    Ok(Numeral { kind, bits: value, warning: negative.then_some(NumeralWarning::Negative) })
}

fn float(text: &str) -> Result<Numeral, Malformed> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes.get(from..).unwrap_or(&[]).iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end += 1;
        end += digits(end);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent == 0 {
            return Err(Malformed::NoExponent);
        }
        end += 1 + sign + exponent;
    }
    if !matches!(text.get(end..), Some("" | "f" | "F")) {
        return Err(Malformed::Suffix(end));
    }
    // Rust parses every spelling that the grammar allows, and rounds once to nearest.
    let value: f32 = text.get(..end).and_then(|number| number.parse().ok()).ok_or(Malformed::Suffix(0))?;
    let warning = value.is_infinite().then_some(NumeralWarning::Infinite);
    Ok(Numeral { kind: TokenKind::Float, bits: value.to_bits(), warning })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers() {
        let bits = |text| read(text).map(|numeral| (numeral.kind, numeral.bits));
        assert_eq!(bits("0"), Ok((TokenKind::Int, 0)));
        assert_eq!(bits("0u"), Ok((TokenKind::Uint, 0)));
        assert_eq!(bits("017"), Ok((TokenKind::Int, 15)));
        assert_eq!(bits("0xFFFFFFFF"), Ok((TokenKind::Int, u32::MAX)));
        assert_eq!(bits("4294967295u"), Ok((TokenKind::Uint, u32::MAX)));
        assert_eq!(read("2147483648").map(|numeral| numeral.warning), Ok(None));
        assert_eq!(read("2147483649").map(|numeral| numeral.warning), Ok(Some(NumeralWarning::Negative)));
        assert_eq!(read("4294967296"), Err(Malformed::TooLarge));
        assert_eq!(read("089"), Err(Malformed::OctalDigit));
        assert_eq!(read("0x"), Err(Malformed::NoDigits));
        assert_eq!(read("0xg"), Err(Malformed::Suffix(2)));
        assert_eq!(read("12ul"), Err(Malformed::Suffix(2)));
        assert_eq!(read("1f"), Err(Malformed::Suffix(1)));
    }

    #[test]
    fn floats() {
        let value = |text| read(text).map(|numeral| f32::from_bits(numeral.bits));
        assert_eq!(value("1."), Ok(1.0));
        assert_eq!(value(".5f"), Ok(0.5));
        assert_eq!(value("1e3"), Ok(1000.0));
        assert_eq!(value("08.5"), Ok(8.5));
        assert_eq!(value("1.5E-3F"), Ok(1.5e-3));
        assert_eq!(read("1e40").map(|numeral| numeral.warning), Ok(Some(NumeralWarning::Infinite)));
        assert_eq!(read("1e"), Err(Malformed::NoExponent));
        assert_eq!(read("1.0.0"), Err(Malformed::Suffix(3)));
        assert_eq!(read("1.0lf"), Err(Malformed::Suffix(3)));
    }
}
