//! The `glisten` program: hands over to the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_vulkan();
    glisten::cli::run(std::env::args_os())
}

/// Keeps Mesa's device-select layer from asking a Wayland server which GPU is the default one: glisten chooses itself,
/// and without a server (`XDG_RUNTIME_DIR` unset, as in a container) that layer writes complaints of its own to
/// standard error, into the midst of JSON.
#[expect(unsafe_code, reason = "the loader of Vulkan's layers takes this switch from the environment alone")]
fn quiet_vulkan() {
    const SWITCH: &str = "NODEVICE_SELECT";
    if std::env::var_os(SWITCH).is_none() {
        // SAFETY: this is the first thing that the program does; no other thread is there to read the environment.
        unsafe { std::env::set_var(SWITCH, "1") };
    }
}
