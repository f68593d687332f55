//! The numbers of the header for stages, targets, formats and precisions. They are numbers and no enumerations, since a host can
//! pass any.

use glisten_binding::{Error, Format, Stage, Target};

/// A stage: one of `GLISTEN_STAGE_`.
pub type StageNumber = u32;
/// The stage that the extension of the source's name tells: `.vert`, `.vs`, `.vsh`, `.geom`, `.frag`, `.fs`, ...
pub const GLISTEN_STAGE_OF_NAME: StageNumber = 0;
/// The vertex stage.
pub const GLISTEN_STAGE_VERTEX: StageNumber = 1;
/// The geometry stage: only GLSL has code for it.
pub const GLISTEN_STAGE_GEOMETRY: StageNumber = 2;
/// The fragment stage.
pub const GLISTEN_STAGE_FRAGMENT: StageNumber = 3;

/// A target language: one of `GLISTEN_TARGET_`.
pub type TargetNumber = u32;
/// The language of WebGPU.
pub const GLISTEN_TARGET_WGSL: TargetNumber = 0;
/// The binary of Vulkan and OpenGL 4.6: 32-bit words, least significant byte first.
pub const GLISTEN_TARGET_SPIRV: TargetNumber = 1;
/// The language of Metal.
pub const GLISTEN_TARGET_MSL: TargetNumber = 2;
/// The language of Direct3D.
pub const GLISTEN_TARGET_HLSL: TargetNumber = 3;
/// The language of OpenGL and WebGL 2, in the version of the option `glsl-version`.
pub const GLISTEN_TARGET_GLSL: TargetNumber = 4;

/// A format of diagnostics: one of `GLISTEN_FORMAT_`.
pub type FormatNumber = u32;
/// Excerpts with carets.
pub const GLISTEN_FORMAT_HUMAN: FormatNumber = 0;
/// A JSON array.
pub const GLISTEN_FORMAT_JSON: FormatNumber = 1;
/// SARIF 2.1.0.
pub const GLISTEN_FORMAT_SARIF: FormatNumber = 2;
/// Workflow commands of GitHub Actions.
pub const GLISTEN_FORMAT_GITHUB: FormatNumber = 3;

static TARGETS: [Target; 5] = [Target::Wgsl, Target::Spirv, Target::Msl, Target::Hlsl, Target::Glsl];
static FORMATS: [Format; 4] = [Format::Human, Format::Json, Format::Sarif, Format::Github];

/// The stage of a number; `None` for `GLISTEN_STAGE_OF_NAME`.
pub(crate) fn stage(number: StageNumber) -> Result<Option<Stage>, Error> {
    match number {
        GLISTEN_STAGE_OF_NAME => Ok(None),
        _ => pick(&Stage::ALL, number - 1, "stage").map(Some),
    }
}

/// The target of a number.
pub(crate) fn target(number: TargetNumber) -> Result<Target, Error> {
    pick(&TARGETS, number, "target")
}

/// The format of a number.
pub(crate) fn format(number: FormatNumber) -> Result<Format, Error> {
    pick(&FORMATS, number, "format")
}

fn pick<T: Copy>(table: &[T], number: u32, what: &str) -> Result<T, Error> {
    let found = table.get(number as usize).copied();
    found.ok_or_else(|| Error::argument(format!("there is no {what} with this number")))
}

#[cfg(test)]
mod tests {
    use super::{GLISTEN_STAGE_FRAGMENT, GLISTEN_TARGET_GLSL, format, stage, target};
    use glisten_binding::{Stage, Target};

    #[test]
    fn numbers_are_looked_up() {
        assert_eq!(stage(GLISTEN_STAGE_FRAGMENT), Ok(Some(Stage::Fragment)));
        assert_eq!(target(GLISTEN_TARGET_GLSL), Ok(Target::Glsl));
        assert!(stage(4).is_err() && target(5).is_err() && format(u32::MAX).is_err());
    }
}
