//! Finds the variants of a scene, in a fixed order by kind.
//!
//! *In:* the scene as written. *Out:* the variants, each added to a list that takes no two alike. *Holds:* a change of a program
//! starts from the specialized one, where exponents are numbers and loops are written out; the specialized program itself is
//! among the variants, so that what a change gains can be told from what specializing gains.

use super::coarser::{Part, tessellated};
use super::models;
use super::{FoundTruth, FoundWay, List, Origin};
use super::{naive, powers, roots, screen, stable, tables, vertex};
use glisten_emit::FloatWidth;
use glisten_front::source::SourceMap;
use glisten_gpu::Via;
use glisten_scene::{Filter, Scene};
use glisten_verify::specialize::{Contract, Math, specialize_scene_by};
use toml::Table;

/// Texels of tables.
const TEXELS: [u32; 4] = [16, 64, 256, 1024];
/// Filters of tables.
const FILTERS: [(Filter, &str); 2] = [(Filter::Nearest, "nearest"), (Filter::Linear, "linear")];

/// The scene, and what most variants start from.
struct Finder<'a, 'o> {
    origin: &'a Origin<'o>,
    /// Specialized.
    base: Scene,
    list: &'a mut List,
}

/// Adds all variants of a scene.
pub(super) fn all(origin: &Origin<'_>, list: &mut List) {
    let base = specialized(origin.scene, Contract::default());
    let mut finder = Finder { origin, base, list };
    finder.contracts();
    let powers = finder.forms();
    finder.powers(&powers);
    finder.roots();
    finder.widths();
    finder.vertices();
    finder.screen();
    finder.tables(&powers);
    let table: Option<Table> = origin.text.parse().ok();
    if let Some(table) = table {
        finder.tessellations(&table);
        finder.models(&table);
    }
}

/// The scene with residual programs.
fn specialized(scene: &Scene, contract: Contract) -> Scene {
    specialize_scene_by(contract, scene, &SourceMap::default(), &[]).scene
}

/// A change of every draw that it can change: the scene, and what was said of each draw.
fn in_draws<T>(scene: &Scene, change: impl Fn(&Scene, usize) -> Option<(Scene, T)>) -> Option<(Scene, Vec<T>)> {
    let (mut changed, mut told) = (scene.clone(), Vec::new());
    for index in 0..scene.draws.len() {
        if let Some((scene, one)) = change(&changed, index) {
            changed = scene;
            told.push(one);
        }
    }
    (!told.is_empty()).then_some((changed, told))
}

impl Finder<'_, '_> {
    fn add(&mut self, (name, kind): (&str, &'static str), about: String, scene: Scene) {
        self.list.add(FoundWay::new((name, kind), about, self.origin.name, scene));
    }

    /// Without what the scene does not need, exactly or not quite.
    fn contracts(&mut self) {
        let exact =
            "Whatever the values of the scene decide is left out of its programs; the picture is the same bit for bit.";
        self.add(("specialized", "specialized"), exact.into(), self.base.clone());
        let finite = Contract { math: Math::Finite, ..Contract::default() };
        let about =
            "Specialized as if no number were infinite or NaN; the picture is the same bit for bit where that holds.";
        self.add(("finite math", "finite-math"), about.into(), specialized(self.origin.scene, finite));
        let fast = Contract { math: Math::Fast, ..Contract::default() };
        let about = "Specialized by the algebra of real numbers, which changes rounding.";
        self.add(("fast math", "fast-math"), about.into(), specialized(self.origin.scene, fast));
        let moved = Contract { move_to_vertex: true, ..Contract::default() };
        let about = "Specialized, and whatever is affine in varyings is computed at the vertices.";
        self.add(("moved to the vertices", "moved"), about.into(), specialized(self.origin.scene, moved));
    }

    /// Stable or plain forms. The scene with plain forms of the library, in which powers are powers.
    fn forms(&mut self) -> Scene {
        if let Some((scene, count)) = in_draws(&self.base, stable::stable) {
            let about = format!("{} in stable forms, the same in exact arithmetic.", counted(&count, "expression"));
            self.add(("stable forms", "stable"), about, specialized(&scene, Contract::default()));
        }
        let Some((scene, names)) = in_draws(self.origin.scene, naive::naive) else { return self.base.clone() };
        let mut names: Vec<&str> = names.into_iter().flatten().collect();
        names.sort_unstable();
        names.dedup();
        let scene = specialized(&scene, Contract::default());
        let about = format!("The equations as printed in the place of the library's safe forms: {}.", names.join(", "));
        self.add(("plain forms", "naive"), about, scene.clone());
        scene
    }

    /// Powers by other means.
    fn powers(&mut self, base: &Scene) {
        if let Some((scene, exponents)) = in_draws(base, powers::squared) {
            let exponents = listed(exponents.into_iter().flatten().map(f64::from));
            let about = format!("Powers of exponent {exponents} as products of squares, the same in exact arithmetic.");
            self.add(("powers by squaring", "pow"), about, specialized(&scene, Contract::default()));
        }
        if let Some((scene, exponents)) = in_draws(base, powers::rational) {
            let exponents = listed(exponents.into_iter().flatten());
            let about = format!(
                "Powers of exponent {exponents} of numbers in [0, 1] in Schlick's rational form (90), another curve."
            );
            self.add(("powers by Schlick's form", "schlick"), about, specialized(&scene, Contract::default()));
        }
    }

    fn roots(&mut self) {
        if let Some((scene, count)) = in_draws(&self.base, roots::inverse) {
            let about =
                format!("{} by `inversesqrt`, the same in exact arithmetic.", counted(&count, "reciprocal root"));
            self.add(("roots by inversesqrt", "inversesqrt"), about, specialized(&scene, Contract::default()));
        }
    }

    /// Floats of other widths.
    fn widths(&mut self) {
        let kinds = [
            (
                FloatWidth::Half,
                "f16",
                "The fragment stage computes in f16; uniforms, varyings and texels are converted.",
            ),
            (
                FloatWidth::Double,
                "f64",
                "Both stages compute in f64; their inputs, outputs and elementary functions are f32.",
            ),
        ];
        for (floats, name, about) in kinds {
            let way = FoundWay::new((name, name), about.into(), self.origin.name, self.base.clone());
            // WGSL has no f64.
            let via = (floats == FloatWidth::Double).then_some(Via::Spirv);
            self.list.add(FoundWay { floats, via, ..way });
        }
    }

    /// Shading at the vertices.
    fn vertices(&mut self) {
        if let Some(scene) = at_vertices(&self.base) {
            let about = "Shaded at the vertices; the colors are interpolated.";
            self.add(("per vertex", "vertex"), about.into(), scene);
        }
    }

    fn screen(&mut self) {
        let changed = in_draws(&self.base, |scene, index| Some((screen::without_perspective(scene, index)?, ())));
        if let Some((scene, _)) = changed {
            let about = "Varyings are interpolated linearly on the screen, without perspective.";
            self.add(("without perspective", "noperspective"), about.into(), scene);
        }
    }

    /// Functions of one number by tables.
    fn tables(&mut self, base: &Scene) {
        let candidates: Vec<Vec<tables::Candidate>> =
            (0..base.draws.len()).map(|index| tables::candidates(base, index)).collect();
        let count: usize = candidates.iter().map(Vec::len).sum();
        if count == 0 {
            return;
        }
        let ranges: Vec<String> = candidates
            .iter()
            .flatten()
            .map(|one| format!("[{}, {}]", short(one.range[0]), short(one.range[1])))
            .collect();
        for texels in TEXELS {
            for (filter, word) in FILTERS {
                let changed = in_draws(base, |scene, index| {
                    let list = candidates.get(index).filter(|list| !list.is_empty())?;
                    Some((tables::by_tables(scene, index, list, texels, filter)?, ()))
                });
                let Some((scene, _)) = changed else { continue };
                let functions = if count == 1 { "1 function" } else { &format!("{count} functions") };
                let about = format!(
                    "{functions} of one number looked up in a texture of {texels} texels, filter {word}, over {}.",
                    ranges.join(", ")
                );
                let name = format!("table of {texels} texels, {word}");
                self.add((&name, "table"), about, specialized(&scene, Contract::default()));
            }
        }
    }

    /// Coarser meshes, and finer ones for what is shaded at the vertices.
    fn tessellations(&mut self, table: &Table) {
        let parts = [(Part(1, 2), "half"), (Part(1, 4), "a quarter"), (Part(2, 1), "twice")];
        for (part, word) in parts {
            let Some((text, counts)) = tessellated(table, part) else { continue };
            let Some(scene) = (self.origin.load)(&text) else { continue };
            let base = specialized(&scene, Contract::default());
            let about = |shading: &str| format!("{shading} with {word} of the mesh's segments and rings.");
            if part.0 < part.1 {
                self.tessellated(("specialized", "tessellation"), about("Specialized,"), base.clone(), counts);
            }
            if let Some(scene) = at_vertices(&base) {
                self.tessellated(("per vertex", "vertex"), about("Shaded at the vertices,"), scene, counts);
            }
        }
    }

    fn tessellated(&mut self, name: (&str, &'static str), about: String, scene: Scene, counts: [u32; 2]) {
        let way = FoundWay::new(name, about, self.origin.name, scene);
        self.list.add(FoundWay { tessellation: Some(counts), ..way });
    }

    /// Other models of the library, each with a reference of its own.
    fn models(&mut self, table: &Table) {
        let shaded = self.list.ways.iter().any(|way| way.kind == "vertex" && way.tessellation.is_none());
        let own = if shaded { None } else { models::per_vertex(table) };
        if let Some(scene) = own.and_then(|text| (self.origin.load)(&text)) {
            let about = "Shaded at the vertices by the library's own program.";
            self.add(("per vertex", "vertex"), about.into(), specialized(&scene, Contract::default()));
        }
        let by_program = models::by_program(table);
        let loaded = by_program.into_iter().filter_map(|(name, text)| Some((name, (self.origin.load)(&text)?)));
        let found: Vec<(&str, Scene)> = models::by_uniform(self.origin.scene).into_iter().chain(loaded).collect();
        for (name, scene) in found {
            let model = format!("{}, {name}", self.origin.name);
            let about =
                format!("Another model of the library, {name}, specialized; its own f64 picture is its reference.");
            let way = FoundWay::new((name, "model"), about, &model, specialized(&scene, Contract::default()));
            let truth = FoundTruth { way: name.into(), scene, tessellation: None };
            self.list.add(FoundWay { truth: Some(truth), ..way });
        }
    }
}

/// Every draw that can be is shaded at its vertices.
fn at_vertices(base: &Scene) -> Option<Scene> {
    let (scene, _) = in_draws(base, |scene, index| Some((vertex::at_vertices(scene, index)?, ())))?;
    Some(specialized(&scene, Contract::default()))
}

/// `3 expressions`
fn counted(counts: &[usize], what: &str) -> String {
    let count: usize = counts.iter().sum();
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// Numbers once each, in order.
fn listed(numbers: impl Iterator<Item = f64>) -> String {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

/// A number for people: three digits.
fn short(number: f64) -> String {
    let rounded = format!("{number:.3}");
    rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
}
