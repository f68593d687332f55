//! Named pipes as outputs.
//!
//! *In:* a path. *Out:* the file to write to. *Holds:* a pipe that nobody reads is an error after [`PATIENCE`]: opening it would wait
//! without end.

use std::fs;
use std::io;
use std::path::Path;
#[cfg(unix)]
use std::time::{Duration, Instant};

/// How long a reader may take to come.
#[cfg(unix)]
const PATIENCE: Duration = Duration::from_secs(10);
/// The time between two looks for it.
#[cfg(unix)]
const POLL: Duration = Duration::from_millis(20);

/// Opens what is no regular file to write to it.
///
/// # Errors
/// It cannot be opened, or is a pipe without a reader.
#[cfg(unix)]
pub(crate) fn open(path: &Path) -> io::Result<fs::File> {
    use rustix::fs::OFlags;
    use rustix::io::Errno;
    use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
    let mut options = fs::OpenOptions::new();
    options.write(true);
    if !fs::metadata(path)?.file_type().is_fifo() {
        return options.open(path);
    }
    let end = Instant::now() + PATIENCE;
    loop {
        // With a reader, neither this nor the second opening waits.
        match options.clone().custom_flags(OFlags::NONBLOCK.bits().cast_signed()).open(path) {
            Ok(_held) => return options.open(path),
            Err(error) if error.raw_os_error() != Some(Errno::NXIO.raw_os_error()) => return Err(error),
            Err(_) if Instant::now() >= end => return Err(io::Error::other("it is a pipe that nobody reads")),
            Err(_) => std::thread::sleep(POLL),
        }
    }
}

/// The same, where pipes have no place among files.
#[cfg(not(unix))]
pub(crate) fn open(path: &Path) -> io::Result<fs::File> {
    fs::OpenOptions::new().write(true).open(path)
}
