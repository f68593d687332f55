//! [`Settings`]: the options of a compilation, each a name and a value as on the command line.

use crate::error::Error;
use crate::includes::Includes;
use crate::sources::share_a_text;
use glisten::diagnostic::{Level, Levels, Severity};
use glisten::emit::{ClipZ, Conventions, FloatWidth, GlslVersion, SpirvEnv, Target, WindowOrigin};
use glisten::source::Prelude;
use glisten::{Compiler, Options, Source};
use glisten_front::compiler::SourceSettings;
use glisten_front::diagnostic::{Key, did_you_mean};
use glisten_sources::engines;
use glisten_sources::engines::STYLES;
use glisten_sources::{Search, completing};

/// Everything that is set before a compilation.
#[derive(Clone, Default)]
pub struct Settings {
    /// The options of the compiler.
    pub options: Options,
    /// What the host of the emitted code expects.
    pub conventions: Conventions,
    /// The levels of warnings.
    pub levels: Levels,
    /// Where includes are looked for.
    pub includes: Includes,
    /// How an engine completes the sources.
    pub source: SourceSettings,
    /// Whether to leave out what reaches no output; by default for WGSL and SPIR-V without source lines.
    pub optimize: Option<bool>,
}

/// Sets an option from a value.
type Setter = fn(&mut Settings, &str) -> Result<(), String>;

/// The options of [`Settings::set`] with the values that they take.
pub static OPTIONS: &[(&str, &str, Setter)] = &[
    ("allow", "a code of a warning", |settings, value| settings.level(Level::Allow, value)),
    ("assume-version", "a version, such as 330 or 150 core", |settings, value| settings.assume_version(value)),
    ("clip-distances", "a number up to 8", |settings, value| {
        let count = value.parse().ok().filter(|count| *count <= 8).ok_or("a number from 0 to 8")?;
        settings.conventions.clip_distances = Some(count);
        Ok(())
    }),
    ("clip-z", "zero-to-one or minus-one-to-one", |settings, value| {
        let words = [("zero-to-one", ClipZ::ZeroToOne), ("minus-one-to-one", ClipZ::MinusOneToOne)];
        word(&words, value).map(|clip| settings.conventions.clip_z = clip)
    }),
    ("debug-lines", "true or false", |settings, value| flag(value).map(|on| settings.conventions.debug_lines = on)),
    ("deny", "a code of a warning, or warnings", |settings, value| settings.level(Level::Deny, value)),
    ("engine", "a name of an engine, such as three or minecraft", |settings, value| settings.engine(value)),
    ("floats", "f16, f32 or f64", |settings, value| {
        let words = [("f16", FloatWidth::Half), ("f32", FloatWidth::Single), ("f64", FloatWidth::Double)];
        word(&words, value).map(|width| settings.conventions.floats = width)
    }),
    ("glsl-version", "330, 450, 300es or vulkan", |settings, value| {
        let versions = GlslVersion::ALL;
        let words = versions.map(|version| (version.word(), version));
        word(&words, value).map(|version| settings.conventions.glsl_version = version)
    }),
    ("include-style", "a style, such as quote, three or moj", |settings, value| {
        let known = STYLES.iter().find(|style| style.name == value).ok_or("")?;
        settings.source.include_style = Some(known.name.to_owned());
        Ok(())
    }),
    ("optimize", "true or false", |settings, value| flag(value).map(|on| settings.optimize = Some(on))),
    ("point-sprites", "true or false", |settings, value| flag(value).map(|on| settings.conventions.point_sprites = on)),
    ("prelude", "a text", |settings, value| {
        let name = format!("<prelude {}>", settings.source.preludes.len() + 1);
        settings.source.preludes.push(Prelude { name, text: value.into() });
        Ok(())
    }),
    ("program-point-size", "true or false", |settings, value| {
        flag(value).map(|on| settings.conventions.program_point_size = on)
    }),
    ("spirv-env", "webgpu or vulkan", |settings, value| {
        let words = [("webgpu", SpirvEnv::Webgpu), ("vulkan", SpirvEnv::Vulkan)];
        word(&words, value).map(|env| settings.conventions.spirv_env = env)
    }),
    ("strict", "true or false", |settings, value| flag(value).map(|on| settings.options.strict = on)),
    ("warn", "a code of a warning", |settings, value| settings.level(Level::Warn, value)),
    ("window-origin", "upper-left or lower-left", |settings, value| {
        let words = [("upper-left", WindowOrigin::UpperLeft), ("lower-left", WindowOrigin::LowerLeft)];
        word(&words, value).map(|origin| settings.conventions.window_origin = origin)
    }),
];

impl Settings {
    /// Sets an option, as the flag of the same name of `glisten compile` does.
    ///
    /// # Errors
    /// There is no such option, or it does not take this value.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), Error> {
        let Some((_, values, set)) = OPTIONS.iter().find(|(other, ..)| *other == name) else {
            let near = did_you_mean(name, OPTIONS.iter().map(|(other, ..)| *other));
            let help = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            return Err(Error::argument(format!("there is no option `{name}`{help}")));
        };
        set(self, value).map_err(|why| match why.is_empty() {
            true => Error::argument(format!("`{name}` is {values}, not `{value}`")),
            false => Error::argument(format!("`{name}`: {why}")),
        })
    }

    /// Defines a macro before the first line of each source.
    ///
    /// # Errors
    /// The name is no identifier, or the value has several lines.
    pub fn define(&mut self, name: &str, value: &str) -> Result<(), Error> {
        let starts_well = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        if !starts_well || !name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
            return Err(Error::argument(format!("`{name}` is not a name for a macro")));
        }
        if value.contains(['\n', '\r']) {
            return Err(Error::argument("a macro's value is one line"));
        }
        self.options.defines.push((name.to_owned(), value.to_owned()));
        Ok(())
    }

    /// Binds a vertex attribute to a location, as `glBindAttribLocation` does (OpenGL 3.2 §2.11.3).
    ///
    /// # Errors
    /// OpenGL has an error for it.
    pub fn bind_attribute(&mut self, name: &str, location: u32) -> Result<(), Error> {
        let binding = binding(name, location, 16, "a location")?;
        self.options.attribute_locations.push(binding);
        Ok(())
    }

    /// Binds a fragment output to a color number, as `glBindFragDataLocation` does (OpenGL 3.2 §3.9.2).
    ///
    /// # Errors
    /// OpenGL has an error for it.
    pub fn bind_output(&mut self, name: &str, number: u32) -> Result<(), Error> {
        let binding = binding(name, number, 8, "a color number")?;
        self.options.frag_data_locations.push(binding);
        Ok(())
    }

    /// The compiler with these settings.
    pub fn compiler(&self) -> Compiler {
        self.compiler_for(&[])
    }

    /// The compiler with these settings for sources of which some may be stages of one text.
    pub(crate) fn compiler_for(&self, sources: &[Source]) -> Compiler {
        let compiler = Compiler::new(self.options.clone());
        let compiler = compiler.with_includes(self.includes.clone()).with_levels(self.levels.clone());
        let is_plain = self.source.is_empty();
        if is_plain && !share_a_text(sources) {
            return compiler;
        }
        let in_memory = self.includes.in_memory || is_plain;
        let search = if in_memory { Search::CompilerAlone } else { Search::CompilerFirst };
        let folders = self.includes.folders.iter().map(|folder| folder.to_string_lossy().into_owned());
        let source = SourceSettings {
            version: self.options.completion.assumed_version.clone(),
            includes: if in_memory { Vec::new() } else { folders.collect() },
            ..self.source.clone()
        };
        completing(compiler, &source, search)
    }

    /// Whether the code for a target is without what reaches no output.
    pub fn optimizes(&self, target: Target) -> bool {
        let by_default = !self.conventions.debug_lines && target.omits_unused();
        self.optimize.unwrap_or(by_default)
    }

    fn level(&mut self, level: Level, key: &str) -> Result<(), String> {
        if key == "warnings" && level == Level::Deny {
            self.levels.deny_warnings();
            return Ok(());
        }
        let found = Key::find(key).ok_or_else(|| format!("there is no code or group `{key}`"))?;
        if let Key::Code(code) = found
            && code.severity == Severity::Error
        {
            return Err(format!("{code} ({}) is an error, which no level changes", code.name));
        }
        self.levels.set_key(found, level);
        Ok(())
    }

    fn engine(&mut self, name: &str) -> Result<(), String> {
        if engines::find(name).is_none() {
            let near = did_you_mean(name, engines::names());
            let help = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            return Err(format!("there is no engine `{name}`{help}"));
        }
        self.source.engine = Some(name.to_owned());
        Ok(())
    }

    fn assume_version(&mut self, text: &str) -> Result<(), String> {
        let (number, profile) = text.split_at(text.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(text.len()));
        let profile = profile.trim();
        if number.len() != 3 || !["", "core", "compatibility", "es"].contains(&profile) {
            return Err(String::new());
        }
        let version = format!("{number} {profile}").trim().to_owned();
        self.options.completion.assumed_version = Some(version);
        Ok(())
    }
}

fn binding(name: &str, number: u32, limit: u32, what: &str) -> Result<(String, u32), Error> {
    if name.is_empty() || name.starts_with("gl_") {
        return Err(Error::argument(format!("`{name}` cannot be bound")));
    }
    if number >= limit {
        return Err(Error::argument(format!("{number} is not {what}: they are 0 to {}", limit - 1)));
    }
    Ok((name.to_owned(), number))
}

fn flag(value: &str) -> Result<bool, String> {
    word(&[("true", true), ("false", false)], value)
}

/// The meaning of a word; an empty reason if there is none.
fn word<T: Copy>(words: &[(&str, T)], value: &str) -> Result<T, String> {
    words.iter().find(|(word, _)| *word == value).map(|(_, meaning)| *meaning).ok_or_else(String::new)
}

#[cfg(test)]
mod tests {
    use super::{OPTIONS, Settings};
    use glisten::{Source, Stage};

    #[test]
    fn options_take_their_words_and_no_others() {
        let mut settings = Settings::default();
        for (name, value) in [
            ("clip-z", "minus-one-to-one"),
            ("window-origin", "lower-left"),
            ("floats", "f16"),
            ("glsl-version", "300es"),
            ("clip-distances", "3"),
            ("deny", "warnings"),
            ("allow", "unused-varying"),
            ("assume-version", "330 core"),
            ("strict", "true"),
        ] {
            assert_eq!(settings.set(name, value), Ok(()), "{name}");
        }
        // Every text may be a prelude.
        for (name, ..) in OPTIONS.iter().filter(|(name, ..)| *name != "prelude") {
            assert!(settings.set(name, "no such word").is_err(), "{name} takes anything");
        }
        let error = settings.set("clip-y", "true").expect_err("there is none");
        assert!(error.message.contains("did you mean `clip-z`"), "{error}");
        assert!(settings.set("deny", "E0001").expect_err("an error").message.contains("no level"));
    }

    #[test]
    fn an_engine_and_preludes_complete_sources() {
        let compiles = |options: &[(&str, &str)], text: &str| {
            let mut settings = Settings::default();
            settings.includes.in_memory = true;
            options.iter().for_each(|(name, value)| assert_eq!(settings.set(name, value), Ok(()), "{name}"));
            let source = Source { name: "a.vert".into(), text: text.into(), stage: Stage::Vertex };
            settings.compiler().compile(&[source]).program.is_some()
        };
        let three = "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
        assert!(compiles(&[("engine", "three")], three) && !compiles(&[], three));
        let own = "#version 150\nvoid main() { gl_Position = scale * at; }";
        let preludes = [("prelude", "uniform mat4 scale;"), ("prelude", "in vec4 at;")];
        assert!(compiles(&preludes, own) && !compiles(&preludes[..1], own));
        let old = "attribute vec4 at; void main() { gl_Position = SCALE * at; }";
        assert!(compiles(&[("prelude", "#define SCALE 2.0"), ("assume-version", "100")], old));
        let error = Settings::default().set("engine", "tree").expect_err("there is none");
        assert!(error.message.contains("did you mean `three`"), "{error}");
    }

    #[test]
    fn names_and_numbers_are_checked() {
        let mut settings = Settings::default();
        assert!(settings.define("A", "1").is_ok() && settings.define("1A", "").is_err());
        assert!(settings.define("B", "a\n#error").is_err());
        assert!(settings.bind_attribute("p", 15).is_ok() && settings.bind_attribute("p", 16).is_err());
        assert!(settings.bind_output("gl_FragColor", 0).is_err() && settings.bind_output("c", 8).is_err());
    }
}
