//! A target of `glisten-fuzz` under libFuzzer: the environment variable `GLISTEN_FUZZ_TARGET` names it.
#![no_main]

use glisten_fuzz::{Target, target};
use std::sync::OnceLock;

static CHOSEN: OnceLock<&'static Target> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    let chosen = CHOSEN.get_or_init(|| {
        let name = std::env::var("GLISTEN_FUZZ_TARGET").unwrap_or_default();
        target(&name).unwrap_or_else(|| panic!("GLISTEN_FUZZ_TARGET: no target `{name}`"))
    });
    (chosen.check)(input);
});
