//! `[require]`: the requirements of a test.

use super::known;
use super::words::{Line, Words};
use super::{TestResult, fail, skip};
use glisten_front::language::EXTENSIONS;

/// The settings that the requirements ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Setup {
    /// The size of the window, in pixels.
    pub(super) size: [u32; 2],
    /// Whether the compatibility profile is requested.
    pub(super) compatibility: bool,
    /// 100 times the version of shaders without a `#version` line.
    pub(super) version: u32,
    /// Whether that is a version of OpenGL ES's language.
    pub(super) es: bool,
}

/// The size of shader_runner's window.
const WINDOW: [u32; 2] = [250, 250];
/// The version of shaders without a `#version` line, if no requirement names one.
const DEFAULT_VERSION: u32 = 110;
/// The largest window that a test may request.
const LARGEST: u32 = 4096;

/// The version of OpenGL: as far as vertex, geometry and fragment shaders go.
const OPENGL: f64 = 4.6;
/// The versions of OpenGL ES and of its language.
const ES: f64 = 3.1;

/// Extensions of the host alone: core in OpenGL 3.2.
const OF_HOST: &[&str] = &[
    "GL_ARB_provoking_vertex",
    "GL_ARB_seamless_cube_map",
    "GL_ARB_texture_float",
    "GL_ARB_texture_rg",
    "GL_EXT_provoking_vertex",
    "GL_EXT_texture_integer",
    "GL_EXT_texture_swizzle",
];

/// Extensions that the compiler implements, but whose tests need functions of a host that is not there.
const WITHOUT_HOST: &[&str] = &["GL_ARB_sample_shading", "GL_ARB_shading_language_include"];

/// Whether an extension is there: one of the host, or one that the compiler implements.
fn is_extension(name: &str) -> bool {
    let implemented = || EXTENSIONS.iter().any(|row| row.name == name);
    OF_HOST.contains(&name) || implemented() && !WITHOUT_HOST.contains(&name)
}

/// The limits: the smallest required maxima (OpenGL 3.2, tables 6.40 and following), or what the compiler takes.
const LIMITS: &[(&str, f64)] = &[
    ("GL_MAX_CLIP_DISTANCES", 8.0),
    ("GL_MAX_CLIP_PLANES", 8.0),
    ("GL_MAX_FRAGMENT_UNIFORM_BLOCKS", 12.0),
    ("GL_MAX_VERTEX_UNIFORM_BLOCKS", 12.0),
    ("GL_MAX_VERTEX_OUTPUT_COMPONENTS", 128.0),
    ("GL_MAX_FRAGMENT_INPUT_COMPONENTS", 128.0),
    ("GL_MAX_GEOMETRY_INPUT_COMPONENTS", 64.0),
    ("GL_MAX_GEOMETRY_OUTPUT_COMPONENTS", 128.0),
    ("GL_MAX_GEOMETRY_OUTPUT_VERTICES", 256.0),
    ("GL_MAX_VARYING_COMPONENTS", 64.0),
    ("GL_MAX_VERTEX_ATTRIBS", 16.0),
    ("GL_MAX_UNIFORM_BLOCK_SIZE", 16384.0),
    // The block of the loose uniforms has 64 KiB, of which each element of an array of `float` takes 16 bytes.
    ("GL_MAX_FRAGMENT_UNIFORM_COMPONENTS", 4096.0),
    ("GL_MAX_VERTEX_UNIFORM_COMPONENTS", 4096.0),
];

/// Checks the requirements. The first one that is not met is a skip.
pub(super) fn check(lines: &[Line]) -> Result<Setup, TestResult> {
    let mut setup = Setup { size: WINDOW, compatibility: false, version: DEFAULT_VERSION, es: false };
    for line in lines {
        let mut words = Words::new(line.number, line.text.strip_prefix("require ").unwrap_or(&line.text));
        match words.word()? {
            // A limit for the operating system; the compiler has limits of its own.
            "rlimit" => {
                words.count()?;
            }
            "GLSL" => {
                setup.es = words.eat("ES");
                let (ours, name) = if setup.es { (ES, "GLSL ES") } else { (4.60, "GLSL") };
                setup.version = (versions(line, &mut words, ours, name)? * 100.0).round() as u32;
            }
            "GL" => {
                setup.compatibility |= words.eat("COMPAT");
                words.eat("CORE");
                let (ours, name) = if words.eat("ES") { (ES, "OpenGL ES") } else { (OPENGL, "OpenGL") };
                versions(line, &mut words, ours, name)?;
            }
            "SIZE" => {
                setup.size = [words.count()?, words.count()?];
                if setup.size.iter().any(|side| !(1..=LARGEST).contains(side)) {
                    return fail(line.number, format_args!("a window is 1 to {LARGEST} pixels wide and high"));
                }
            }
            "depthbuffer" => {}
            // Separate programs are linked as one: what each stage computes is the same.
            "SSO" if words.eat("ENABLED") => {}
            "SSO" => return known::mistake(line.number, &line.text, "a requirement", ["SSO ENABLED"]),
            "INT" => {
                let name = words.word()?;
                limit(line, name, &mut words)?;
            }
            name if words.rest().first().is_some_and(|word| OPERATORS.contains(word)) => {
                limit(line, name, &mut words)?;
            }
            name if name.starts_with("!GL_") => {
                if is_extension(&name[1..]) {
                    return skip(line.number, format_args!("requires that {} is missing", &name[1..]));
                }
            }
            name if is_extension(name) => {}
            other => return known::requirement(line, other, []),
        }
        words.end()?;
    }
    Ok(setup)
}

/// The requested version, if the comparison holds.
fn versions(line: &Line, words: &mut Words<'_>, ours: f64, what: &str) -> Result<f64, TestResult> {
    let asked = words.rest().get(1).and_then(|word| word.parse().ok()).unwrap_or(0.0);
    let holds = comparison(words, ours)?;
    if holds { Ok(asked) } else { skip(line.number, format_args!("requires {}, this is {what} {ours:.2}", line.text)) }
}

fn limit(line: &Line, name: &str, words: &mut Words<'_>) -> Result<(), TestResult> {
    let Some((_, ours)) = LIMITS.iter().find(|(limit, _)| *limit == name) else {
        return known::requirement(line, name, LIMITS.iter().map(|row| row.0));
    };
    if comparison(words, *ours)? {
        Ok(())
    } else {
        skip(line.number, format_args!("requires {}, it is {ours}", line.text))
    }
}

/// The comparisons of requirements.
const OPERATORS: &[&str] = &["!=", "<", "<=", "=", "==", ">", ">="];

/// Evaluates a comparison such as `>= 1.50` with the supported value.
fn comparison(words: &mut Words<'_>, ours: f64) -> Result<bool, TestResult> {
    let operator = words.word()?;
    if !OPERATORS.contains(&operator) {
        return known::mistake(words.line, operator, "a comparison", OPERATORS.iter().copied());
    }
    let wanted = words.number()?;
    Ok(match operator {
        ">=" => ours >= wanted,
        ">" => ours > wanted,
        "<=" => ours <= wanted,
        "<" => ours < wanted,
        "=" | "==" => ours == wanted,
        _ => ours != wanted,
    })
}

#[cfg(test)]
mod unit {
    use super::*;

    fn checked(text: &str) -> Result<Setup, TestResult> {
        check(&[Line { number: 1, text: text.into() }])
    }

    #[test]
    fn what_is_met_and_what_is_not() {
        for met in [
            "GLSL >= 1.30",
            "GL >= 3.2",
            "GL_ARB_texture_rg",
            "GL_MAX_CLIP_DISTANCES >= 8",
            "depthbuffer",
            "GL ES >= 3.0",
        ] {
            assert!(checked(met).is_ok(), "{met}");
        }
        for unmet in [
            "GLSL >= 4.70",
            "GL < 3.0",
            "GL_ARB_gpu_shader_fp64",
            "GL_MAX_VERTEX_OUTPUT_COMPONENTS >= 256",
            "GLSL ES >= 3.20",
        ] {
            assert!(matches!(checked(unmet), Err(TestResult::Skip(_))), "{unmet}");
        }
        for mistaken in [
            "GLLS >= 1.50",
            "GLSL => 1.50",
            "SZIE 10 10",
            "GLSL 1.50",
            "GLSL >= 1.50 core",
            "SIZE 5 5 5",
            "GL_ARB_texture_rg enabled",
            "SSO ENABLD",
        ] {
            assert!(matches!(checked(mistaken), Err(TestResult::Fail(_))), "{mistaken}");
        }
        let near = |name: &str| checked(name).err().and_then(|result| result.reason().map(str::to_owned));
        let told = "line 1: requires GL_MAX_CLIP_DISTANCS >= 8; did you mean `GL_MAX_CLIP_DISTANCES`?";
        assert_eq!(near("GL_MAX_CLIP_DISTANCS >= 8").as_deref(), Some(told));
        assert_eq!(checked("SIZE 10 20").map(|setup| setup.size), Ok([10, 20]));
    }
}
