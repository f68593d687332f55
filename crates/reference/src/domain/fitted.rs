//! The numbers that no specification states: measured on a driver, or chosen.
//!
//! *In:* the constants where they are used. *Out:* [`FITTED`], with a row for each: its value, the profile that it belongs
//! to, and the command that measures it. *Holds:* the values are those in use, not copies. The docs print the table.

use super::rules::{self, Step};
use super::{Profile, limits};
use glisten_scene::compare::{evidence, population, whole};

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
const TIMED: &str =
    "chosen: a march of 96 steps takes less than 10 s; `cargo test --test it -- widths` shows what becomes wider";
const CALIBRATED: &str = "`cargo run --release -p glisten-studies --bin population -- fixtures/scenes shader_lib/scenes --programs 0..1000` prints the alarms";

const POPULATION_TEST: &str =
    "`cargo test --test it -- scenes`: pictures of derivatives and of filters are as the population's";

/// A constant of all profiles.
const fn constant(what: &'static str, value: f64, unit: &'static str, measured: &'static str) -> Fitted {
    Fitted { what, value, unit, profile: "all", measured }
}

const fn row(step: &Step, value: f64, unit: &'static str, measured: &'static str) -> Fitted {
    Fitted { what: step.operation, value, unit, profile: "all", measured }
}

/// All fitted constants.
pub static FITTED: &[Fitted] = &[
    row(&rules::VARYING, rules::VARYING.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::SLOPE, rules::SLOPE.ulps(), "ULP", ENVELOPE_TEST),
    row(&rules::SNAPPING, rules::SNAPPING.absolute(), "pixels", ENVELOPE_TEST),
    row(&rules::POINT_VARYING, rules::POINT_VARYING.ulps(), "ULP", "`cargo test --test it -- borders`"),
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
        what: "rows and columns of a quad that have derivatives of their own",
        value: 2.0,
        unit: "",
        profile: "device, for llvmpipe alone; else 1 or 2",
        measured: POPULATION_TEST,
    },
    Fitted {
        what: "bits of the weights of linear filters, for textures of floats",
        value: 24.0,
        unit: "bits",
        profile: "device, for llvmpipe alone; else from 8 on",
        measured: POPULATION_TEST,
    },
    constant("lanes for all paths of the fragments of a run", super::LANES as f64, "", CHOSEN),
    constant("undecided conditions that a path may meet", limits::MOST_OPEN as f64, "", TIMED),
    constant("width of a number that such a path may have", limits::WIDEST, "sizes of the value", TIMED),
    constant("texels that a lookup with filtering may touch", limits::MOST_TEXELS as f64, "", CHOSEN),
    constant("texels that `texelFetch` may read", limits::MOST_FETCHED as f64, "", CHOSEN),
    constant("size of a point", limits::POINT_SIZE_ERROR, "pixels", RASTER_TEST),
    constant("distance of a suspect from the population", population::FAR, "widths of its range", CALIBRATED),
    constant("least width of that range", evidence::LEAST, "of the picture's range", CALIBRATED),
    constant("distance across a jump", population::BEYOND_JUMP, "widths of the range of the pixels around", CALIBRATED),
    constant("pixels that may lie across a jump", population::MAX_JUMPS, "of those covered", CALIBRATED),
    constant(
        "width of an envelope from which it may hide a jump",
        evidence::GOAL,
        "of the picture's range",
        CALIBRATED,
    ),
    constant("suspects from which a picture fails", population::MIN_SHARE, "of the covered pixels", CALIBRATED),
    constant("suspects from which a picture fails, at least", population::MIN_PIXELS as f64, "pixels", CALIBRATED),
    constant("distance of a picture as a whole", whole::FAR_AS_A_WHOLE, "widths of the population's range", CALIBRATED),
    constant("least width of that range", evidence::OF_A_MEAN, "of that for a pixel", CALIBRATED),
    constant("pixels that a mean over a picture leaves out", whole::TRIMMED, "at either end", CALIBRATED),
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
