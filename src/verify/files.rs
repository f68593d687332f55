//! The pictures of a verification that failed.
//!
//! *In:* a [`Verification`]. *Out:* PNG files in a folder: one of each runner, `cpu.png`, `difference.png`.

use super::Verification;
use glisten_scene::picture::{ImageFormat, Picture};
use std::path::{Path, PathBuf};

/// Writes the pictures; returns the folder, or why they cannot be written.
pub(super) fn write(folder: &Path, verification: &Verification) -> Result<PathBuf, String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for run in &verification.runs {
        write_picture(folder, run.runner, &run.picture)?;
    }
    write_picture(folder, "cpu", &verification.reference)?;
    write_picture(folder, "difference", &verification.difference())?;
    Ok(folder.to_owned())
}

/// A file for each attachment; those after the first are numbered.
fn write_picture(folder: &Path, name: &str, picture: &Picture) -> Result<(), String> {
    for attachment in 0..picture.attachments.len() {
        let number = if attachment > 0 { format!(".{attachment}") } else { String::new() };
        let path = folder.join(format!("{name}{number}.png"));
        let bytes = picture.encode(attachment, ImageFormat::Png).map_err(|error| error.to_string())?;
        std::fs::write(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}
