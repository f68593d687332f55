//! The `glisten` program, which hands over to the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_vulkan();
    glisten::cli::run_supervised(std::env::args_os())
}

/// Keeps Mesa's device-select layer from asking a Wayland server for the default GPU: glisten selects the GPU itself.
/// Without a server (`XDG_RUNTIME_DIR` unset, as in a container), that layer would write complaints to standard
/// error.
#[expect(unsafe_code, reason = "the loader of Vulkan's layers takes this switch from the environment alone")]
fn quiet_vulkan() {
    const SWITCH: &str = "NODEVICE_SELECT";
    if std::env::var_os(SWITCH).is_none() {
        // SAFETY: this is the first thing that the program does; no other thread exists that could read the
        // environment.
        unsafe { std::env::set_var(SWITCH, "1") };
    }
}
