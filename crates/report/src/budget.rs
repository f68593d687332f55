//! [`Budget`]: the cheapest variant whose error is small enough.
//!
//! *In:* limits of error figures (`rmse=1e-3,psnr>=40`), and a report. *Out:* for each model a [`Choice`]: the variant within the
//! limits that takes the least work, and the one that takes the least time if it is clearly faster.
//!
//! *Holds:* a variant that is unfit for the fronts is within no budget, nor is one in f16 or f64, whose program GLSL 1.50 cannot
//! express. Of equal variants the more exact one is chosen, then the first.

use super::front::{is_faster, unfit};
use super::model::{Figures, Report, Way};
use glisten_emit::FloatWidth;
use glisten_front::diagnostic::did_you_mean;
use glisten_front::hir::Stage;
use glisten_scene::{Scene, ShaderFiles, write};
use glisten_specialize::{Known, Residual};
use std::sync::Arc;

/// An error figure that may have a limit.
#[derive(Clone, Copy, Debug)]
struct Measure {
    name: &'static str,
    of: fn(&Figures) -> f64,
    /// Whether the limit is the least value: more is better.
    least: bool,
}

const MEASURES: [Measure; 5] = [
    Measure { name: "rmse", of: |figures| figures.rmse, least: false },
    Measure { name: "max_abs", of: |figures| figures.max_abs, least: false },
    Measure { name: "max_ulp", of: |figures| figures.max_ulp, least: false },
    Measure { name: "flip", of: |figures| figures.flip.unwrap_or(f64::NAN), least: false },
    // Equal pictures have none, which is better than any.
    Measure { name: "psnr", of: |figures| figures.psnr.unwrap_or(f64::INFINITY), least: true },
];

/// Limits of error figures.
#[derive(Clone, Debug)]
pub struct Budget {
    limits: Vec<(Measure, f64)>,
}

/// The answer for a model.
#[derive(Clone, Debug)]
pub struct Choice<'a> {
    /// The model.
    pub model: &'a str,
    /// The variant with the least work within the budget.
    pub cheapest: Option<&'a Way>,
    /// The variant with the least time within it, if it is clearly faster.
    pub fastest: Option<&'a Way>,
    /// The variant with the least RMSE, for those who have nothing within the budget.
    pub closest: Option<&'a Way>,
}

impl Budget {
    /// Reads limits: `rmse=1e-3`, `flip<=0.01,psnr>=40`.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        let limits = text.split(',').map(limit).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { limits })
    }

    fn holds(&self, figures: &Figures) -> bool {
        self.limits.iter().all(|(measure, limit)| {
            let value = (measure.of)(figures);
            if measure.least { value >= *limit } else { value <= *limit }
        })
    }

    /// The figures of a variant that have limits: `rmse 1.2e-3`.
    pub fn figures(&self, way: &Way) -> String {
        let told = |(measure, _): &(Measure, f64)| {
            let value = (measure.of)(&way.error);
            if measure.least { format!("{} {value:.1}", measure.name) } else { format!("{} {value:.2e}", measure.name) }
        };
        self.limits.iter().map(told).collect::<Vec<_>>().join(", ")
    }
}

/// A limit as it is written.
fn limit(text: &str) -> Result<(Measure, f64), String> {
    let text = text.trim();
    let split = [("<=", false), (">=", true), ("=", false)].into_iter().find_map(|(sign, least)| {
        text.split_once(sign).map(|(name, value)| (name.trim(), value.trim(), (sign != "=").then_some(least)))
    });
    let Some((name, value, least)) = split else {
        return Err(format!("`{text}` is not a limit; write `rmse=1e-3`"));
    };
    let names = MEASURES.map(|measure| measure.name);
    let Some(measure) = MEASURES.into_iter().find(|measure| measure.name == name) else {
        let near = did_you_mean(name, names).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        return Err(format!("there is no error figure `{name}` (there are {}){near}", names.join(", ")));
    };
    if least.is_some_and(|least| least != measure.least) {
        let sign = if measure.least { ">=" } else { "<=" };
        return Err(format!("the limit of `{name}` is written `{name}{sign}{value}`"));
    }
    match value.parse::<f64>() {
        Ok(limit) if limit.is_finite() && limit >= 0.0 => Ok((measure, limit)),
        _ => Err(format!("`{value}` is not a limit of `{name}`, which is a number of at least 0")),
    }
}

impl Report {
    /// The cheapest variants within a budget, a model after the other.
    pub fn choose(&self, budget: &Budget) -> Vec<Choice<'_>> {
        let unfit = unfit(&self.ways, &self.truths);
        let fit: Vec<&Way> = self
            .ways
            .iter()
            .zip(&unfit)
            .filter(|(way, unfit)| !**unfit && way.floats == FloatWidth::Single)
            .map(|(way, _)| way)
            .collect();
        let mut models: Vec<&str> = Vec::new();
        for way in &self.ways {
            if !models.contains(&way.model.as_str()) {
                models.push(&way.model);
            }
        }
        let choice = |model| {
            let members: Vec<&Way> = fit.iter().copied().filter(|way| way.model == model).collect();
            let within: Vec<&Way> = members.iter().copied().filter(|way| budget.holds(&way.error)).collect();
            let cheapest = within.iter().copied().reduce(|best, way| if is_cheaper(way, best) { way } else { best });
            let beats = |way: &Way| {
                let others = within.iter().filter(|other| !std::ptr::eq(**other, way));
                others.into_iter().all(|other| is_faster(&way.times, &other.times, self.timing.margin))
            };
            let fastest = within.iter().copied().find(|way| beats(way));
            let closest = members.into_iter().min_by(|a, b| a.error.rmse.total_cmp(&b.error.rmse));
            Choice { model, cheapest, fastest, closest }
        };
        models.into_iter().map(choice).collect()
    }
}

fn is_cheaper(way: &Way, than: &Way) -> bool {
    (way.work.operations, way.error.rmse) < (than.work.operations, than.error.rmse)
}

/// The program of a variant: a scene in the explicit core, and the GLSL texts that it names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WayFiles {
    /// The text of the scene.
    pub scene: String,
    /// Names and texts of the shaders.
    pub shaders: Vec<(String, String)>,
}

impl Way {
    /// The files that draw the variant; shaders are named after `stem`.
    pub fn files(&self, stem: &str) -> WayFiles {
        let (scene, programs) = match &self.programs {
            Some(programs) => ((*self.scene).clone(), programs.clone()),
            None => printed(&self.scene),
        };
        let mut shaders: Vec<(String, String)> = Vec::new();
        let mut names = Vec::new();
        for (number, texts) in programs.iter().enumerate() {
            let stem = if number == 0 { stem.to_owned() } else { format!("{stem}_{}", number + 1) };
            for (stage, text) in texts {
                shaders.push((format!("{stem}.{}", extension(*stage)), text.clone()));
            }
            names.extend(scene.draws.get(number).map(|draw| ShaderFiles::of(draw, &stem)));
        }
        WayFiles { scene: write(&scene, &names), shaders }
    }
}

fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// A scene with the texts of its programs, as the printer writes them: nothing is left out but what no host could see.
fn printed(scene: &Scene) -> (Scene, Vec<Vec<(Stage, String)>>) {
    let mut result = scene.clone();
    result.draws.clear();
    let mut programs = Vec::new();
    for draw in &scene.draws {
        let Residual { stages, program, .. } = glisten_specialize::specialize(&draw.program, &Known::default());
        result.draws.push(glisten_verify::specialize::with_program(draw, Arc::new(program), &[]));
        programs.push(stages.into_iter().map(|stage| (stage.stage, stage.text)).collect());
    }
    (result, programs)
}

#[cfg(test)]
mod tests {
    use super::super::page::tests::example;
    use super::*;

    fn chosen(budget: &str) -> Vec<(Option<String>, Option<String>)> {
        let report = example();
        let choices = report.choose(&Budget::parse(budget).expect(budget));
        let title = |way: Option<&Way>| way.map(Way::title);
        choices.iter().map(|choice| (title(choice.cheapest), title(choice.fastest))).collect()
    }

    #[test]
    fn the_cheapest_way_within_the_limits_is_chosen() {
        // Coarse meshes take less work, and less time.
        let all = chosen("rmse=1");
        assert_eq!(all.len(), 2);
        assert_eq!(all[0].0.as_deref(), Some("Phong per fragment, 16x8"));
        assert_eq!(all[0].1.as_deref(), Some("Phong per vertex, 16x8"), "another way is faster");
        let exact = chosen("rmse<=1e-9");
        assert_eq!(exact, [(None, None), (None, None)]);
        let closest = example();
        let closest = closest.choose(&Budget::parse("rmse=0").expect("a budget"));
        assert_eq!(closest[0].closest.map(Way::title).as_deref(), Some("Phong per fragment, 64x32"));
    }

    #[test]
    fn several_limits_hold_together() {
        let one = chosen("rmse=1e-4");
        assert_eq!(one[0].0.as_deref(), Some("Phong per fragment, 64x32"));
        assert_eq!(one[0].1, one[0].0, "it is alone");
        assert_eq!(chosen("rmse=1e-4, psnr>=200")[0].0, None);
    }

    #[test]
    fn limits_that_are_wrong_are_told() {
        for (text, told) in [
            ("rsme=1", "did you mean `rmse`?"),
            ("rmse", "is not a limit"),
            ("", "is not a limit"),
            ("rmse=small", "`small`"),
            ("rmse=-1", "at least 0"),
            ("rmse=nan", "at least 0"),
            ("psnr<=40", "`psnr>=40`"),
            ("flip>=0.1", "`flip<=0.1`"),
            ("rmse=1e-3,,", "is not a limit"),
        ] {
            let error = Budget::parse(text).expect_err(text);
            assert!(error.contains(told), "{text}: {error}");
        }
        for good in ["rmse=1e-3", "max_abs <= 0.1", "psnr=40", "max_ulp=4,flip=0.02"] {
            assert!(Budget::parse(good).is_ok(), "{good}");
        }
    }
}
