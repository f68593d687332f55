//! [`Clock`]: how long something takes, where there is a clock.
//!
//! *In:* nothing. *Out:* milliseconds; 0 in WebAssembly, where a module without imports has no clock.

/// A time that began.
pub(super) struct Clock(#[cfg(not(target_family = "wasm"))] std::time::Instant);

impl Clock {
    /// Begins now.
    pub(super) fn start() -> Self {
        Self(
            #[cfg(not(target_family = "wasm"))]
            std::time::Instant::now(),
        )
    }

    /// The milliseconds since then.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn milliseconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64() * 1e3
    }

    /// The milliseconds since then.
    #[cfg(target_family = "wasm")]
    pub(super) fn milliseconds(&self) -> f64 {
        0.0
    }
}
