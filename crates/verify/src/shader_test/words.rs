//! Lines of a test, and their words, separated by white space, commas and parentheses.

use super::{TestResult, fail};

/// A line and its number, counted from 1, without its comment and surrounding white space.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    pub(super) number: u32,
    pub(super) text: String,
}

/// The words of a line that have not been read.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    pub(super) line: u32,
    words: Vec<&'a str>,
    next: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(line: u32, text: &'a str) -> Self {
        let words = text.split(|c: char| c.is_whitespace() || "(),".contains(c)).filter(|word| !word.is_empty());
        Self { line, words: words.collect(), next: 0 }
    }

    /// Reads these words if they are next.
    pub(super) fn eat(&mut self, phrase: &str) -> bool {
        let wanted: Vec<&str> = phrase.split(' ').collect();
        let is_next = self.rest().starts_with(&wanted);
        if is_next {
            self.next += wanted.len();
        }
        is_next
    }

    /// The words that have not been read.
    pub(super) fn rest(&self) -> &[&'a str] {
        self.words.get(self.next..).unwrap_or_default()
    }

    /// Passes over the words that have not been read.
    pub(super) fn pass_over(&mut self) {
        self.next = self.words.len();
    }

    /// Fails if words are left that mean something.
    pub(super) fn end(&self) -> Result<(), TestResult> {
        match self.rest() {
            [] => Ok(()),
            [word, ..] if word.starts_with("//") || *word == ";" => Ok(()),
            [word, ..] => fail(self.line, format_args!("`{word}` is too much at the end")),
        }
    }

    /// The next word.
    pub(super) fn word(&mut self) -> Result<&'a str, TestResult> {
        let Some(word) = self.words.get(self.next) else { return fail(self.line, "a word is missing at the end") };
        self.next += 1;
        Ok(word)
    }

    /// The next word as a number.
    pub(super) fn number(&mut self) -> Result<f64, TestResult> {
        self.number_by(parse_number)
    }

    /// The next word as an integer. A hexadecimal integer is its own value, not the bits of a float. As in shader_runner, a fraction is
    /// dropped.
    pub(super) fn whole(&mut self) -> Result<f64, TestResult> {
        self.number_by(|word| parse_integer(word).filter(|number| number.is_finite()).map(f64::trunc))
    }

    fn number_by(&mut self, parse: fn(&str) -> Option<f64>) -> Result<f64, TestResult> {
        let word = self.word()?;
        // C's functions ignore what follows a number, and some tests end their lines with a semicolon.
        match parse(word.trim_end_matches(';')) {
            Some(number) => Ok(number),
            None => fail(self.line, format_args!("`{word}` is not a number")),
        }
    }

    /// The next `N` words as numbers.
    pub(super) fn numbers<const N: usize>(&mut self) -> Result<[f64; N], TestResult> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Ok(numbers)
    }

    /// The next word as a count or an index.
    pub(super) fn count(&mut self) -> Result<u32, TestResult> {
        let number = self.number()?;
        if number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0 {
            Ok(number as u32)
        } else {
            fail(self.line, format_args!("{number} is not a count"))
        }
    }
}

/// A decimal number, `inf` or `nan`, or the bits of a float in hexadecimal.
pub(super) fn parse_number(word: &str) -> Option<f64> {
    if let Some(bits) = word.strip_prefix("0x") {
        return u32::from_str_radix(bits, 16).ok().map(|bits| f64::from(f32::from_bits(bits)));
    }
    word.parse().ok()
}

/// A decimal or hexadecimal integer, with or without a sign, and with or without GLSL's `u` at its end, which the functions of C that
/// shader_runner calls do not read.
pub(super) fn parse_integer(word: &str) -> Option<f64> {
    let (sign, digits) = word.strip_prefix('-').map_or((1.0, word), |digits| (-1.0, digits));
    let digits = digits.strip_suffix(['u', 'U']).unwrap_or(digits);
    let magnitude = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hexadecimal) => f64::from(u32::from_str_radix(hexadecimal, 16).ok()?),
        None => digits.parse().ok()?,
    };
    Some(sign * magnitude)
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn parentheses_and_commas_part_words() {
        let mut words = Words::new(1, "relative probe rgb (0.5, .25) (1, 0,-1e3)");
        assert!(!words.eat("relative probe rgba") && words.eat("relative probe rgb"));
        assert_eq!(words.numbers::<5>(), Ok([0.5, 0.25, 1.0, 0.0, -1000.0]));
        assert!(words.word().is_err());
    }

    #[test]
    fn hexadecimal_is_the_bits_of_a_float() {
        assert_eq!(parse_number("0x3f800000"), Some(1.0));
        assert_eq!(parse_number("x"), None);
        assert_eq!(parse_integer("-0x10"), Some(-16.0));
        assert_eq!(["0u", "0xFFu", "u"].map(parse_integer), [Some(0.0), Some(255.0), None]);
        assert_eq!(Words::new(1, "0.75;").number(), Ok(0.75));
    }
}
