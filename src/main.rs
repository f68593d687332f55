//! The `glisten` program, which hands over to the command line.

use std::alloc::{GlobalAlloc, Layout, System};
use std::process::ExitCode;

/// The system's memory. Where it gives none, `--max-memory` may have been the reason.
struct Limited;

#[global_allocator]
static MEMORY: Limited = Limited;

fn main() -> ExitCode {
    quiet_vulkan();
    glisten::cli::run_supervised(std::env::args_os())
}

#[expect(unsafe_code, reason = "allocators are unsafe; this one hands everything over")]
// SAFETY: each call is the system's, whose answer is not changed.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        told(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        told(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise.
        told(unsafe { System.realloc(block, layout, size) })
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(block, layout) }
    }
}

fn told(block: *mut u8) -> *mut u8 {
    if block.is_null() {
        glisten::cli::memory::exhausted();
    }
    block
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
