//! The stage of a shader, by the name of its file.

use clap::ValueEnum;
use glisten_front::hir::Stage;
use std::path::Path;

/// File extensions, with their stages.
static EXTENSIONS: &[(&str, Stage)] = &[
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("glslv", Stage::Vertex),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
    ("glslf", Stage::Fragment),
    ("geom", Stage::Geometry),
    ("gs", Stage::Geometry),
    ("gsh", Stage::Geometry),
];

/// A stage on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum StageArg {
    /// Vertex shader.
    #[value(alias = "vert")]
    Vertex,
    /// Fragment shader.
    #[value(alias = "frag")]
    Fragment,
    /// Geometry shader.
    #[value(alias = "geom")]
    Geometry,
}

impl From<StageArg> for Stage {
    fn from(stage: StageArg) -> Self {
        match stage {
            StageArg::Vertex => Self::Vertex,
            StageArg::Fragment => Self::Fragment,
            StageArg::Geometry => Self::Geometry,
        }
    }
}

/// The stage of a file extension.
pub(super) fn by_extension(path: &Path) -> Option<Stage> {
    let extension = path.extension()?.to_str()?;
    EXTENSIONS.iter().find(|(known, _)| known.eq_ignore_ascii_case(extension)).map(|(_, stage)| *stage)
}

/// The stage of a file name, including `phong.vert.glsl`, which a folder scan does not pick up.
pub(super) fn by_name(path: &Path) -> Option<Stage> {
    by_extension(path).or_else(|| by_extension(Path::new(without_glsl(path)?)))
}

fn without_glsl(path: &Path) -> Option<&str> {
    path.file_name()?.to_str()?.strip_suffix(".glsl")
}

/// The name without the part that says the stage: `phong` for `phong.vert` and for `phong.vert.glsl`.
pub(super) fn stem(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let inner = match without_glsl(path) {
        Some(inner) if by_extension(Path::new(inner)).is_some() => inner,
        _ => &name,
    };
    Path::new(inner).file_stem().map_or(name.clone(), |stem| stem.to_string_lossy().into_owned())
}

/// All extensions with their dots, for messages.
pub(super) fn all_extensions() -> String {
    EXTENSIONS.iter().map(|(extension, _)| format!(".{extension}")).collect::<Vec<_>>().join(" ")
}
