//! Which uniforms are worth fixing: what each saves over a set of scenes, and how many programs it makes of one.
//!
//! *In:* scenes. *Out:* a [`Suggestion`]: the uniforms ranked by the operations that are saved because they are fixed, and the
//! curve of programs against work as they are fixed one after the other. *Holds:* operations are counted on the reference, so
//! they are the same on every machine. Nothing but uniforms is fixed: meshes and textures are the scenes' own affair, and
//! residuals that differ by these alone are one program.

use super::known::known;
use super::residual::with_program;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::link::Program;
use glisten_reference::{Precision, work};
use glisten_scene::Scene;
use glisten_scene::dynamic::names_uniform;
use glisten_specialize::{Known, Options};
use glisten_variants::specialize_smallest;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What fixing uniforms gains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suggestion {
    /// The scenes.
    pub scenes: Vec<String>,
    /// Operations of all pictures with no uniform fixed.
    pub operations_none: u64,
    /// Operations of all pictures with every uniform fixed.
    pub operations_all: u64,
    /// The uniforms, the one that saves most first.
    pub uniforms: Vec<Ranked>,
    /// Programs and work as the uniforms are fixed one after the other, in that order.
    pub curve: Vec<Point>,
}

/// A uniform and what it saves.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Ranked {
    /// Its name; of a struct or an array the name of the whole.
    pub name: String,
    /// The operations that are executed more if all are fixed but this one.
    pub saves: u64,
    /// How many values it has in the scenes.
    pub values: usize,
    /// The programs that are left if this one alone is not fixed.
    pub variants_without: usize,
}

/// A point of the curve.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Point {
    /// The uniform that is fixed from here on; none for the first point.
    pub fixed: Option<String>,
    /// The number of programs.
    pub variants: usize,
    /// Operations of all pictures.
    pub operations: u64,
}

/// The text of each residual, and the program.
type Residuals = BTreeMap<Vec<String>, Arc<Program>>;

struct Study<'a> {
    scenes: &'a [(String, &'a Scene)],
    /// What each draw of each scene fixes at most.
    known: Vec<Vec<Known>>,
    residuals: Residuals,
    /// Operations by scene, draw and residual.
    counted: BTreeMap<(usize, usize, Vec<String>), u64>,
}

/// Ranks the uniforms of scenes. `step` is called after each of `steps` measurements.
///
/// # Errors
/// What the reference cannot do.
pub fn suggest(
    scenes: &[(String, &Scene)],
    dynamic: &[String],
    step: &mut dyn FnMut(usize, usize),
) -> Result<Suggestion, Vec<Diagnostic>> {
    let of_scene = |scene: &Scene| -> Vec<Known> {
        let uniforms = |draw| Known { uniforms: known(draw, &scene.framebuffer, dynamic).uniforms, ..Known::default() };
        scene.draws.iter().map(uniforms).collect()
    };
    let known = scenes.iter().map(|(_, scene)| of_scene(scene)).collect();
    let mut study = Study { scenes, known, residuals: Residuals::new(), counted: BTreeMap::new() };
    let names = study.names();
    let steps = names.len() * 2 + 1;
    let all: BTreeSet<&str> = names.iter().map(String::as_str).collect();
    let (_, operations_all) = study.measure(&all)?;
    step(1, steps);
    let mut uniforms = Vec::with_capacity(names.len());
    for (index, name) in names.iter().enumerate() {
        let without: BTreeSet<&str> = all.iter().copied().filter(|other| other != name).collect();
        let (variants_without, operations) = study.measure(&without)?;
        let saves = operations.saturating_sub(operations_all);
        uniforms.push(Ranked { name: name.clone(), saves, values: study.values(name), variants_without });
        step(index + 2, steps);
    }
    uniforms.sort_by(|a, b| b.saves.cmp(&a.saves).then(a.values.cmp(&b.values)).then(a.name.cmp(&b.name)));
    let mut fixed = BTreeSet::new();
    let (variants, operations_none) = study.measure(&fixed)?;
    let mut curve = vec![Point { fixed: None, variants, operations: operations_none }];
    for (index, one) in uniforms.iter().enumerate() {
        fixed.insert(one.name.as_str());
        let (variants, operations) = study.measure(&fixed)?;
        curve.push(Point { fixed: Some(one.name.clone()), variants, operations });
        step(names.len() + index + 2, steps);
    }
    let scenes = scenes.iter().map(|(name, _)| name.clone()).collect();
    Ok(Suggestion { scenes, operations_none, operations_all, uniforms, curve })
}

impl Study<'_> {
    /// The uniforms that some draw fixes: loose ones as a whole, members of blocks one by one.
    fn names(&self) -> Vec<String> {
        let mut names = BTreeSet::new();
        for ((_, scene), known) in self.scenes.iter().zip(&self.known) {
            for (draw, known) in scene.draws.iter().zip(known) {
                let interface = &draw.program.interface;
                let fixed =
                    interface.uniforms.iter().filter(|leaf| leaf.active && known.uniforms.contains_key(&leaf.name));
                names.extend(fixed.map(|leaf| match interface.roots.get(leaf.root.0 as usize) {
                    Some(root) if root.block.is_none() => root.name.clone(),
                    _ => leaf.name.clone(),
                }));
            }
        }
        names.into_iter().collect()
    }

    /// How many values a uniform has.
    fn values(&self, name: &str) -> usize {
        let mut values = BTreeSet::new();
        for ((_, scene), known) in self.scenes.iter().zip(&self.known) {
            for (draw, known) in scene.draws.iter().zip(known) {
                values.insert(format!("{:?}", only(&draw.program, known, &BTreeSet::from([name])).uniforms));
            }
        }
        values.len()
    }

    /// The number of programs, and the operations of all pictures, with these uniforms fixed.
    fn measure(&mut self, fixed: &BTreeSet<&str>) -> Result<(usize, u64), Vec<Diagnostic>> {
        let (mut programs, mut operations) = (BTreeSet::new(), 0);
        for (scene, (_, original)) in self.scenes.iter().enumerate() {
            for (index, draw) in original.draws.iter().enumerate() {
                let Some(known) = self.known.get(scene).and_then(|known| known.get(index)) else { continue };
                let residual =
                    specialize_smallest(&draw.program, &only(&draw.program, known, fixed), &Options::default());
                let texts: Vec<String> = residual.stages.iter().map(|stage| stage.text.clone()).collect();
                let program = self.residuals.entry(texts.clone()).or_insert_with(|| Arc::new(residual.program));
                let key = (scene, index, texts.clone());
                let count = match self.counted.get(&key) {
                    Some(count) => *count,
                    None => {
                        let mut alone = (*original).clone();
                        alone.draws = vec![with_program(draw, Arc::clone(program), &[])];
                        let counted = work(&alone, &super::error::options(Precision::F32))?;
                        counted.iter().map(|one| one.vertex_operations + one.fragment_operations).sum()
                    }
                };
                operations += count;
                self.counted.insert(key, count);
                programs.insert(texts);
            }
        }
        Ok((programs.len(), operations))
    }
}

/// What is known of these uniforms alone.
fn only(program: &Program, known: &Known, names: &BTreeSet<&str>) -> Known {
    let interface = &program.interface;
    let fixed =
        |leaf: &&glisten_front::link::UniformLeaf| names.iter().any(|name| names_uniform(interface, name, leaf));
    let leaves = interface.uniforms.iter().filter(fixed);
    let values = leaves.filter_map(|leaf| Some((leaf.name.clone(), known.uniforms.get(&leaf.name)?.clone())));
    Known { uniforms: values.collect(), ..Known::default() }
}
