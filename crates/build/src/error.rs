//! [`BuildError`]: the reasons why a build writes nothing.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A failed build.
#[derive(Debug)]
#[non_exhaustive]
pub enum BuildError {
    /// Shaders have errors.
    Shaders {
        /// All errors, as `glisten lint` prints them.
        text: String,
        /// The files that were read.
        read: Vec<PathBuf>,
    },
    /// A file or folder cannot be read or written.
    File {
        /// Its path.
        path: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// A folder contains no program.
    NoProgram(PathBuf),
    /// A shader of a folder has no partner of the same name.
    NoPartner(PathBuf),
    /// A folder contains a geometry shader, which the targets of a build do not have.
    Geometry(PathBuf),
    /// There is no engine of this name.
    NoEngine {
        /// The name.
        name: String,
        /// The engine that may be meant.
        similar: Option<String>,
    },
    /// A version that sources are assumed to have is none.
    Version(String),
    /// A fixed uniform has another number of components.
    Fixed {
        /// Its name.
        uniform: String,
        /// How many it has, of all elements together.
        wanted: u32,
        /// How many were given.
        given: usize,
    },
    /// No program has a fixed uniform.
    NoUniform {
        /// Its name.
        uniform: String,
        /// The uniform that may be meant.
        similar: Option<String>,
    },
    /// Two programs would be modules of the same name.
    SameName(String),
    /// Outside of a build script there is no `OUT_DIR`, and no other folder was given.
    NoFolder,
}

impl BuildError {
    /// The files that a build script should be run for again.
    pub fn read(&self) -> &[PathBuf] {
        match self {
            Self::Shaders { read, .. } => read,
            Self::File { path, .. } | Self::NoProgram(path) | Self::NoPartner(path) | Self::Geometry(path) => {
                std::slice::from_ref(path)
            }
            Self::NoEngine { .. } | Self::Version(_) => &[],
            Self::Fixed { .. } | Self::NoUniform { .. } | Self::SameName(_) | Self::NoFolder => &[],
        }
    }
}

fn suggest(f: &mut fmt::Formatter<'_>, similar: Option<&str>) -> fmt::Result {
    similar.map_or(Ok(()), |similar| write!(f, "; did you mean `{similar}`?"))
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shaders { text, .. } => f.write_str(text),
            Self::File { path, error } => write!(f, "{}: {error}", path.display()),
            Self::NoProgram(path) => {
                write!(f, "{}: no vertex shader (.vert, .vs, .vsh) is in this folder", path.display())
            }
            Self::NoPartner(path) => write!(
                f,
                "{}: its program has no other stage; name it with `Build::program`, or move it out of the folder",
                path.display()
            ),
            Self::Geometry(path) => write!(
                f,
                "{}: WGSL has no geometry shaders; leave it out of the folder, or name the other stages with `Build::program`",
                path.display()
            ),
            Self::NoEngine { name, similar } => {
                write!(f, "there is no engine `{name}`")?;
                suggest(f, similar.as_deref())
            }
            Self::Version(why) => f.write_str(why),
            Self::Fixed { uniform, wanted, given } => {
                write!(
                    f,
                    "`{uniform}` has {wanted} components, of all elements together, and is fixed to {given} numbers"
                )
            }
            Self::NoUniform { uniform, similar } => {
                write!(f, "no program has the uniform `{uniform}` that is fixed")?;
                suggest(f, similar.as_deref())
            }
            Self::SameName(name) => {
                write!(f, "two programs would be the module `{name}`; name one with `Build::named_program`")
            }
            Self::NoFolder => {
                f.write_str("OUT_DIR is not set, as it is in build scripts; name a folder with `output_folder`")
            }
        }
    }
}

impl std::error::Error for BuildError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File { error, .. } => Some(error),
            _ => None,
        }
    }
}
