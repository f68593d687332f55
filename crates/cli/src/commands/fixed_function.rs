//! `glisten fixed-function`: the stages of OpenGL's fixed-function pipeline as GLSL.
//!
//! *In:* switches, or a scene with draws that name only one stage. *Out:* the text of a stage, or of both, on standard output
//! or in files.

use crate::arguments::args::{BindingArgs, LevelArgs, SourceArgs};
use crate::batch::Batch;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::{self, SceneFiles};
use crate::session::Session;
use clap::builder::PossibleValuesParser;
use clap::{ArgAction, Args, ValueEnum};
use glisten_front::Stage;
use glisten_scene::fixed::{
    ColorMaterial, EnvironmentMode, FogMode, FogSource, GlslDialect, NormalScaling, Pipeline, TexGen, TextureTarget,
    TextureUnit, UNITS,
};
use glisten_verify::scene;
use std::path::PathBuf;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten fixed-function --lights 2 --fog exp --unit modulate", "both stages, with their switches"),
    ("glisten fixed-function scene.toml", "the stages that the draws of a scene do not name"),
];

/// Write the vertex and the fragment stage of OpenGL's fixed-function pipeline as GLSL
#[derive(Args, Debug)]
// Its `--version` is that of the language to write.
#[command(disable_version_flag = true)]
pub(crate) struct FixedFunctionArgs {
    /// A scene with draws that name one stage: the other ones are written
    #[arg(value_name = "SCENE.toml", conflicts_with_all = SWITCHES)]
    scene: Option<String>,
    /// The stage to write (default: both)
    #[arg(long, value_enum)]
    stage: Option<FixedStage>,
    /// The language to write
    #[arg(long, value_enum, default_value_t, value_name = "VERSION")]
    version: VersionArg,
    /// Print the version of the program, as `--version` does of other commands
    #[arg(short = 'V', action = ArgAction::Version)]
    _program: Option<bool>,
    /// Write `fixed.vert` and `fixed.frag` into this folder (default: standard output)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Enable lighting by the first N light sources
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=8))]
    lights: Option<u32>,
    /// Highlights are those of a viewer at the origin of eye space
    #[arg(long)]
    local_viewer: bool,
    /// Back faces are lit with the back material
    #[arg(long)]
    two_side: bool,
    /// Add highlights after the textures
    #[arg(long)]
    separate_specular: bool,
    /// Which colors of the material are the vertex's
    #[arg(long, value_name = "COLORS", value_parser = PossibleValuesParser::new(names(ColorMaterial::NAMES)))]
    color_material: Option<String>,
    /// How normals are scaled after their transformation
    #[arg(long, value_name = "HOW", value_parser = PossibleValuesParser::new(names(NormalScaling::NAMES)))]
    normals: Option<String>,
    /// Fog
    #[arg(long, value_name = "MODE", value_parser = PossibleValuesParser::new(names(FogMode::NAMES)))]
    fog: Option<String>,
    /// The number that fog grows with
    #[arg(long, value_name = "SOURCE", value_parser = PossibleValuesParser::new(names(FogSource::NAMES)))]
    fog_source: Option<String>,
    /// Add the secondary color after the textures
    #[arg(long)]
    color_sum: bool,
    /// The size of points depends on their distance
    #[arg(long)]
    point_attenuation: bool,
    /// Write `gl_ClipVertex`, for clip planes
    #[arg(long)]
    clip: bool,
    /// A texture unit: its environment, its target and the generation of its coordinates, as `decal:2d:sphere_map` (repeatable)
    #[arg(long = "unit", value_name = "MODE[:TARGET[:GENERATE]]", value_parser = parse_unit)]
    units: Vec<TextureUnit>,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The switches that a scene has in its tables.
const SWITCHES: &[&str] = &[
    "lights",
    "local_viewer",
    "two_side",
    "separate_specular",
    "color_material",
    "normals",
    "fog",
    "fog_source",
    "color_sum",
    "point_attenuation",
    "clip",
    "units",
    "version",
];

/// A stage of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FixedStage {
    /// Transformation, lighting, texture coordinates
    Vertex,
    /// Texture environments, color sum, fog
    Fragment,
}

/// The language to write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum VersionArg {
    /// `#version 120`
    #[default]
    #[value(name = "120")]
    V120,
    /// `#version 150 compatibility`
    #[value(name = "150")]
    V150,
}

fn names<T>(rows: &'static [(&'static str, T)]) -> Vec<&'static str> {
    rows.iter().map(|row| row.0).collect()
}

fn named<T: Copy + Default>(rows: &[(&str, T)], name: Option<&str>) -> T {
    rows.iter().find(|row| Some(row.0) == name).map(|row| row.1).unwrap_or_default()
}

fn parse_unit(text: &str) -> Result<TextureUnit, String> {
    let mut parts = text.split(':');
    let unit = TextureUnit {
        mode: part(parts.next(), EnvironmentMode::NAMES)?,
        target: part(parts.next(), TextureTarget::NAMES)?,
        generate: part(parts.next(), TexGen::NAMES)?,
        ..TextureUnit::default()
    };
    parts.next().map_or(Ok(unit), |rest| Err(format!("`{rest}` is one part too many")))
}

fn part<T: Copy + Default>(name: Option<&str>, rows: &'static [(&'static str, T)]) -> Result<T, String> {
    let Some(name) = name else { return Ok(T::default()) };
    let row = rows.iter().find(|row| row.0 == name);
    row.map(|row| row.1).ok_or_else(|| format!("`{name}` is none of {}", names(rows).join(", ")))
}

impl FixedFunctionArgs {
    fn pipeline(&self) -> Result<Pipeline, Failure> {
        if self.units.len() > UNITS {
            return Err(Failure::usage(format!("there are {UNITS} texture units, and these are {}", self.units.len())));
        }
        let lights = self.lights.unwrap_or(0) as usize;
        Ok(Pipeline {
            dialect: match self.version {
                VersionArg::V120 => GlslDialect::V120,
                VersionArg::V150 => GlslDialect::V150,
            },
            lighting: self.lights.is_some(),
            lights: std::array::from_fn(|index| index < lights),
            local_viewer: self.local_viewer,
            two_side: self.two_side,
            separate_specular: self.separate_specular,
            color_material: named(ColorMaterial::NAMES, self.color_material.as_deref()),
            normals: named(NormalScaling::NAMES, self.normals.as_deref()),
            units: std::array::from_fn(|index| self.units.get(index).copied()),
            color_sum: self.color_sum,
            fog: named(FogMode::NAMES, self.fog.as_deref()),
            fog_source: named(FogSource::NAMES, self.fog_source.as_deref()),
            point_attenuation: self.point_attenuation,
            clip: self.clip,
            texture_coordinates: None,
        })
    }
}

/// Runs the command.
pub(crate) fn run(args: &FixedFunctionArgs, console: &Console) -> Outcome {
    let texts = match &args.scene {
        Some(path) => match of_scene(args, path, console)? {
            Ok(texts) => texts,
            Err(exit) => return Ok(exit),
        },
        None => {
            let pipeline = args.pipeline()?;
            vec![
                ("fixed.vert".to_owned(), Stage::Vertex, pipeline.vertex()),
                ("fixed.frag".to_owned(), Stage::Fragment, pipeline.fragment()),
            ]
        }
    };
    let is_asked = |stage: Stage| match args.stage {
        Some(FixedStage::Vertex) => stage == Stage::Vertex,
        Some(FixedStage::Fragment) => stage == Stage::Fragment,
        None => true,
    };
    let texts: Vec<_> = texts.into_iter().filter(|(_, stage, _)| is_asked(*stage)).collect();
    let Some(folder) = &args.output else {
        let all: Vec<&str> = texts.iter().map(|(.., text)| text.as_str()).collect();
        console.output(&all.join("\n"))?;
        return Ok(Exit::Ok);
    };
    files::make_folder(folder)?;
    for (name, _, text) in &texts {
        files::write(&folder.join(name), text.as_bytes())?;
    }
    Ok(Exit::Ok)
}

/// The stages that the draws of a scene lack, each with the name of a file.
type Texts = Vec<(String, Stage, String)>;

fn of_scene(args: &FixedFunctionArgs, path: &str, console: &Console) -> Result<Result<Texts, Exit>, Failure> {
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 0)?;
    let loaded = scene::load(path, &SceneFiles, session.compiler());
    let mut batch = Batch { sources: loaded.sources, diagnostics: Vec::new() };
    session.add(&mut batch, loaded.diagnostics);
    session.tell(&[&batch], false)?;
    let Some(scene) = loaded.scene else {
        return Ok(Err(if loaded.io_error { Exit::Usage } else { Exit::Content }));
    };
    let made = scene.draws.iter().enumerate().filter_map(|(index, draw)| {
        let (stage, pipeline) = draw.fixed.as_ref()?.generated.as_ref()?;
        let (extension, text) = match stage {
            Stage::Vertex => ("vert", pipeline.vertex()),
            Stage::Geometry | Stage::Fragment => ("frag", pipeline.fragment()),
        };
        let number = if scene.draws.len() > 1 { format!("_{index}") } else { String::new() };
        Some((format!("fixed{number}.{extension}"), *stage, text))
    });
    let texts: Texts = made.collect();
    if texts.is_empty() {
        let failure = Failure::new(Exit::Content, format!("every draw of `{path}` names both stages"));
        return Err(failure.help("leave `vertex` or `fragment` out, or give switches such as `--lights 1`"));
    }
    Ok(Ok(texts))
}
