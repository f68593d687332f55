//! The numbers that no specification states: measured on a driver, or chosen.
//!
//! *In:* the constants where they are used. *Out:* [`FITTED`], with a row for each: its value, the profile that it belongs
//! to, and the command that measures it. *Holds:* the values are those in use, not copies. The docs print the table.

use super::Profile;
use super::rules::{self, Step};

/// A fitted constant.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    /// The quantity that it limits.
    pub what: &'static str,
    /// The number in use.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// The profiles that have it.
    pub profile: &'static str,
    /// How it is measured, or why it was chosen.
    pub measured: &'static str,
}

const ENVELOPE_TEST: &str = "`cargo test --test it -- envelope::measured --nocapture`";
const RASTER_TEST: &str = "`cargo test --test it -- raster`";
const NUMERIC_TEST: &str = "`cargo test --test it -- numeric --nocapture`";
const REPORTED: &str =
    "reported by the adapter (`VkPhysicalDeviceLimits`); without a report, this for llvmpipe, else Vulkan's 4";
const CHOSEN: &str = "chosen: a budget of time";

const fn row(step: &Step, value: f64, unit: &'static str, measured: &'static str) -> Fitted {
    Fitted { what: step.operation, value, unit, profile: "all", measured }
}

/// All fitted constants.
pub static FITTED: &[Fitted] = &[
    row(&rules::VARYING, rules::VARYING.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::SLOPE, rules::SLOPE.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::SNAPPING, rules::SNAPPING.absolute(), "pixels", ENVELOPE_TEST),
    row(&rules::POINT_COORD, rules::POINT_COORD.absolute(), "", RASTER_TEST),
    row(&rules::TEXEL_COORDINATE, rules::TEXEL_COORDINATE.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::CUBE_COORDINATE, rules::CUBE_COORDINATE.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::COMPARED_DEPTH, rules::COMPARED_DEPTH.ulps(), "ULP", RASTER_TEST),
    row(&rules::FILTER_SUM, rules::FILTER_SUM.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::STORE_SLACK, rules::STORE_SLACK.absolute(), "", ENVELOPE_TEST),
    Fitted {
        what: "`sin` and `cos` beyond pi, besides 2^-11",
        value: 1.0,
        unit: "ULP of the argument",
        profile: "all",
        measured: ENVELOPE_TEST,
    },
    Fitted {
        what: "bits of window positions",
        value: Profile::LLVMPIPE.subpixel_bits as f64,
        unit: "bits",
        profile: "device",
        measured: REPORTED,
    },
    Fitted {
        what: "bits of coordinates in texels",
        value: Profile::LLVMPIPE.subtexel_bits as f64,
        unit: "bits",
        profile: "device",
        measured: REPORTED,
    },
    Fitted {
        what: "bits of levels of detail",
        value: Profile::LLVMPIPE.mipmap_bits as f64,
        unit: "bits",
        profile: "device",
        measured: REPORTED,
    },
    Fitted {
        what: "error of a division by a power of two",
        value: 0.0,
        unit: "ULP",
        profile: "device, for llvmpipe alone; else 2.5",
        measured: NUMERIC_TEST,
    },
    Fitted {
        what: "lanes for all ways of the fragments of a run",
        value: super::LANES as f64,
        unit: "",
        profile: "all",
        measured: CHOSEN,
    },
];

#[cfg(test)]
mod tests {
    use super::{FITTED, rules};

    #[test]
    fn every_rule_of_our_own_is_in_the_table() {
        for step in rules::OWN {
            assert!(FITTED.iter().any(|row| row.what == step.operation), "{}", step.operation);
        }
    }
}
