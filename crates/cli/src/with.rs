//! `--with [DRAW:]STAGE=FILE`: modules of other translators, drawn in place of the emitted ones.
//!
//! *In:* the values of the option, a scene. *Out:* the modules, read and checked. *Holds:* a `.wgsl` runs by WGSL alone, a
//! `.spv` by SPIR-V alone.

use crate::arguments::stages::StageArg;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::scenes::gpu_failure;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::did_you_mean;
use glisten_front::hir::Stage;
use glisten_gpu::{Foreign, Via};
use glisten_verify::scene::Scene;

/// The largest size of a file that is read; the reader of modules has a smaller limit of its own.
const MAX_BYTES: usize = 16 << 20;

/// Modules of other translators.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct WithArgs {
    /// Draw with this module in place of the emitted one (repeatable); its interface must be what `compile` gives. Without
    /// DRAW, counted from 0, it replaces the stage in every draw
    #[arg(long = "with", value_name = "[DRAW:]STAGE=FILE.spv|FILE.wgsl", value_parser = parse, conflicts_with = "specialize")]
    modules: Vec<With>,
}

/// A value of the option.
#[derive(Clone, Debug, PartialEq, Eq)]
struct With {
    draw: Option<usize>,
    stage: Stage,
    file: String,
    via: Via,
}

fn parse(text: &str) -> Result<With, String> {
    let (place, file) = text.split_once('=').ok_or("write [DRAW:]STAGE=FILE")?;
    let (draw, stage) = match place.split_once(':') {
        Some((draw, stage)) => {
            let number = draw.parse().map_err(|_| format!("`{draw}` is not the number of a draw, counted from 0"))?;
            (Some(number), stage)
        }
        None => (None, place),
    };
    let stage = match StageArg::from_str(stage, false).map(Stage::from) {
        Ok(stage @ (Stage::Vertex | Stage::Fragment)) => stage,
        Ok(Stage::Geometry) => return Err("a geometry stage cannot be drawn".to_owned()),
        Err(_) => {
            let near = did_you_mean(stage, ["vertex", "fragment"]);
            let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(format!("`{stage}` is not a stage{near}"));
        }
    };
    let extension = std::path::Path::new(file).extension().map(|extension| extension.to_ascii_lowercase());
    let via = match extension.as_ref().and_then(|extension| extension.to_str()) {
        Some("wgsl") => Via::Wgsl,
        Some("spv") => Via::Spirv,
        _ => return Err(format!("`{file}` must end in .wgsl or .spv, which says what the module is")),
    };
    Ok(With { draw, stage, file: file.to_owned(), via })
}

impl WithArgs {
    /// The forms that run: all of `wanted`, without modules; with modules, those that have some. `named` is the form that
    /// the user asked for.
    pub(crate) fn vias(&self, wanted: &[Via], named: bool) -> Result<Vec<Via>, Failure> {
        let Some(first) = self.modules.first() else { return Ok(wanted.to_vec()) };
        if let Some(other) = self.modules.iter().find(|module| named && !wanted.contains(&module.via)) {
            let (file, via) = (&other.file, other.via.name());
            return Err(Failure::usage(format!("`{file}` runs by {via} alone, and --via asks for another form")));
        }
        let of = |via: &Via| self.modules.iter().any(|module| module.via == *via);
        let vias: Vec<Via> = wanted.iter().copied().filter(of).collect();
        Ok(if vias.is_empty() { vec![first.via] } else { vias })
    }

    /// Refuses modules of which only one of two can be drawn, by one of these forms.
    fn refuse_idle(&self, vias: &[Via]) -> Result<(), Failure> {
        for (index, module) in self.modules.iter().enumerate() {
            let file = &module.file;
            if !vias.contains(&module.via) {
                let (via, runs) = (module.via.name(), vias.first().map_or("", |via| via.name()));
                return Err(Failure::usage(format!("`{file}` runs by {via} alone, and what is drawn runs by {runs}")));
            }
            let is_replaced = |later: &&With| {
                later.via == module.via
                    && later.stage == module.stage
                    && later.draw.is_none_or(|draw| Some(draw) == module.draw)
            };
            if let Some(later) = self.modules.iter().skip(index + 1).find(is_replaced) {
                let message =
                    format!("--with: `{file}` and `{}` are for the same {} stage", later.file, later.stage.name());
                return Err(Failure::usage(message).help("write the one for all draws first, or leave one out"));
            }
        }
        Ok(())
    }

    /// The modules, for a scene that has the draws and is drawn by these forms.
    pub(crate) fn read(&self, scene: &Scene, vias: &[Via]) -> Result<Vec<Foreign>, Failure> {
        self.refuse_idle(vias)?;
        self.modules.iter().map(|module| module.read(scene)).collect()
    }
}

impl With {
    fn read(&self, scene: &Scene) -> Result<Foreign, Failure> {
        let Self { draw, stage, file, via } = self;
        let count = scene.draws.len();
        if let Some(draw) = draw.filter(|draw| *draw >= count) {
            let draws = if count == 1 { "one draw, 0".to_owned() } else { format!("{count} draws, counted from 0") };
            return Err(Failure::usage(format!("--with: there is no draw {draw}: the scene has {draws}")));
        }
        let bytes = files::read(file, file.as_ref()).map_err(|error| Failure::usage(error.message))?;
        if bytes.len() > MAX_BYTES {
            let message = format!("`{file}`: the file has {} bytes, and at most {MAX_BYTES} are read", bytes.len());
            return Err(Failure::new(Exit::Content, message));
        }
        Foreign::read(*draw, *stage, file, &bytes, *via).map_err(gpu_failure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_the_option() {
        let with = |draw, stage, file: &str, via| Ok(With { draw, stage, file: file.to_owned(), via });
        assert_eq!(parse("fragment=a.wgsl"), with(None, Stage::Fragment, "a.wgsl", Via::Wgsl));
        assert_eq!(parse("2:vertex=x/a=b.SPV"), with(Some(2), Stage::Vertex, "x/a=b.SPV", Via::Spirv));
        let cases = [
            ("fragment", "write"),
            ("=a.wgsl", "not a stage"),
            ("fragmnt=a.wgsl", "did you mean `fragment`"),
            ("geometry=a.wgsl", "cannot be drawn"),
            ("-1:vertex=a.wgsl", "not the number of a draw"),
            ("fragment=a.frag", "must end in"),
            ("fragment=", "must end in"),
        ];
        for (text, part) in cases {
            assert!(parse(text).is_err_and(|why| why.contains(part)), "{text}");
        }
    }

    #[test]
    fn a_module_runs_in_its_form_alone() {
        let both = [Via::Spirv, Via::Wgsl];
        let of = |files: &[&str]| WithArgs {
            modules: files.iter().map(|file| parse(&format!("fragment={file}")).expect("it is valid")).collect(),
        };
        assert_eq!(of(&[]).vias(&both, false), Ok(both.to_vec()));
        assert_eq!(of(&["a.wgsl"]).vias(&both, false), Ok(vec![Via::Wgsl]));
        assert_eq!(of(&["a.wgsl", "a.spv"]).vias(&both, false), Ok(both.to_vec()));
        assert_eq!(of(&["a.wgsl"]).vias(&[Via::Spirv], false), Ok(vec![Via::Wgsl]));
        assert!(of(&["a.wgsl"]).vias(&[Via::Spirv], true).is_err());
    }
}
