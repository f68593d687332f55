//! From which number on suspects fail a comparison.
//!
//! *In:* the number of pixels inside their envelope, but far outside of what a population of simulated GPUs drew. *Out:*
//! whether that is more than chance makes. *Holds:* a few suspects fail nothing, however small the picture is.

/// The share of the covered pixels above which suspects fail.
pub const MIN_SHARE: f64 = 0.001;

/// The number of suspects that fail at least.
pub const MIN_PIXELS: u64 = 8;

/// Whether so many suspects fail a comparison.
pub(super) fn fail(suspect: u64, covered: u64) -> bool {
    suspect >= MIN_PIXELS && suspect as f64 > MIN_SHARE * covered as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_suspects_fail_nothing() {
        let cases = [(7, 100, false), (8, 100, true), (8, 8000, false), (9, 8000, true)];
        for (suspect, covered, expected) in cases {
            assert_eq!(fail(suspect, covered), expected, "{suspect} of {covered}");
        }
    }
}
