//! Writes the pictures of a failed verification.
//!
//! *In:* pictures by name. *Out:* PNG files in a folder.

use glisten_scene::picture::{ImageFormat, Picture};
use std::path::{Path, PathBuf};

/// Writes pictures as `NAME.png` into a folder, which is created if it is missing. Returns the folder.
///
/// # Errors
/// Why they cannot be written.
pub fn write_pictures(folder: &Path, pictures: &[(&str, &Picture)]) -> Result<PathBuf, String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    pictures.iter().try_for_each(|(name, picture)| write_picture(folder, name, picture))?;
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
