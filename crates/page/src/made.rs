//! [`Made`]: the making of a page, as the page describes it, so that it can be repeated.
//!
//! *In:* the arguments of a command and the time. *Out:* the command, the version and the date as texts. *Not done here:*
//! nothing reads the clock or the environment; the command line does.

use serde::Serialize;

/// How a page was made.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Made {
    /// The command with its arguments, as a shell takes it.
    pub command: String,
    /// The version of glisten.
    pub version: String,
    /// The day in UTC: `2026-11-22`.
    pub date: String,
}

impl Made {
    /// A page that `arguments`, without the program's name, made so many seconds after the beginning of 1970.
    pub fn new(arguments: &[String], seconds: u64) -> Self {
        let words: Vec<String> = arguments.iter().map(|word| shell_word(word)).collect();
        let command = format!("glisten {}", words.join(" "));
        Self { command, version: env!("CARGO_PKG_VERSION").to_owned(), date: date(seconds) }
    }
}

/// A word as a shell takes it.
pub fn shell_word(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=,:%+@".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// The day of the proleptic Gregorian calendar, by eras of 400 years that begin in March.
pub fn date(seconds: u64) -> String {
    // Far beyond any clock, the calendar ends.
    let days = (seconds / 86_400).min(100_000_000) + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let (month, next_year) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{day:02}", era * 400 + year_of_era + next_year)
}

#[cfg(test)]
mod tests {
    use super::{Made, date, shell_word};

    #[test]
    fn days_have_their_dates() {
        for (seconds, day) in [
            (0, "1970-01-01"),
            (86_399, "1970-01-01"),
            (68_169_600, "1972-02-29"),
            (951_868_800, "2000-03-01"),
            (1_795_305_600, "2026-11-22"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(date(seconds), day);
        }
        assert!(date(u64::MAX).len() > 9);
    }

    #[test]
    fn commands_can_be_pasted() {
        let words = ["report", "my scene.toml", "-o", "it's"].map(str::to_owned);
        assert_eq!(Made::new(&words, 0).command, r"glisten report 'my scene.toml' -o 'it'\''s'");
        assert_eq!(shell_word(""), "''");
    }
}
