//! [`Sweep`]: values of a uniform to draw with.
//!
//! *In:* `NAME=LOW..HIGH:N`. *Out:* scenes with other values of the uniform. *Holds:* both ends are among the values.

use glisten_front::diagnostic::codes::scenes::{SCENE_UNKNOWN_NAME, SCENE_WRONG_KIND, SCENE_WRONG_VALUE};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::hir::{Scalar, ScalarValue};
use glisten_front::link::{Program, UniformLeaf};
use glisten_front::source::Span;
use glisten_reference::stability::{Stability, pictures_of};
use glisten_scene::Scene;
use glisten_scene::values::{LeafShape, UniformValues};
use serde::Serialize;
use std::collections::BTreeMap;

/// The number of values unless it is given.
pub const DEFAULT_COUNT: usize = 16;
/// The largest number of values of one sweep, and of combinations of all.
pub const MOST: usize = 4096;

/// The values of a uniform, or of a component of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The uniform as the reflection names it, with `.x` to `.w` for a component of a vector, `[1].x` for one of a column of a
    /// matrix.
    pub name: String,
    /// The first value.
    pub low: f64,
    /// The last value.
    pub high: f64,
    /// The number of values, 2 at least unless both ends are equal.
    pub count: usize,
    /// Its place in a scene file; unknown if it is from elsewhere.
    pub place: Span,
}

/// Reads `NAME=LOW..HIGH[:N]`.
///
/// # Errors
/// What is wrong with it.
pub fn parse(text: &str) -> Result<Sweep, String> {
    let Some((name, range)) = text.split_once('=') else {
        return Err(format!("`{text}` is not NAME=LOW..HIGH[:N]"));
    };
    parse_range(name.trim(), range.trim())
}

/// Reads `LOW..HIGH[:N]`.
pub(super) fn parse_range(name: &str, text: &str) -> Result<Sweep, String> {
    let malformed = || format!("`{text}` is not LOW..HIGH[:N], such as 0..1 or 1..1e4:32");
    let (ends, count) = match text.rsplit_once(':') {
        Some((ends, count)) => (ends, Some(count.trim().parse::<f64>().map_err(|_| malformed())?)),
        None => (text, None),
    };
    let (low, high) = ends.split_once("..").ok_or_else(malformed)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| malformed());
    Sweep::new(name, number(low)?, number(high)?, count)
}

impl Sweep {
    /// A sweep from `low` to `high`.
    ///
    /// # Errors
    /// What is wrong with the numbers.
    pub fn new(name: &str, low: f64, high: f64, count: Option<f64>) -> Result<Self, String> {
        let count = count.unwrap_or(DEFAULT_COUNT as f64);
        match () {
            () if name.is_empty() => Err("a sweep needs the name of a uniform".to_owned()),
            () if !low.is_finite() || !high.is_finite() => Err("the ends of a sweep are finite numbers".to_owned()),
            () if count.fract() != 0.0 || !(2.0..=MOST as f64).contains(&count) => {
                Err(format!("a sweep has 2 to {MOST} values"))
            }
            () => Ok(Self { name: name.to_owned(), low, high, count: count as usize, place: Span::default() }),
        }
    }

    /// The values, evenly spaced; by their logarithm if they span three decades and have one sign.
    pub fn values(&self) -> Vec<f64> {
        let (low, high) = (self.low, self.high);
        let last = (self.count - 1).max(1) as f64;
        let by_decades = low * high > 0.0 && (high / low >= 1e3 || low / high >= 1e3);
        (0..self.count)
            .map(|step| match step as f64 / last {
                0.0 => low,
                1.0 => high,
                t if by_decades => low * (high / low).powf(t),
                t => low + (high - low) * t,
            })
            .collect()
    }
}

/// A scalar of a uniform in every draw that has it.
#[derive(Clone, Debug)]
pub struct Parameter {
    name: String,
    /// The draw, the root, and the position in it, with the type.
    places: Vec<(usize, usize, usize, Scalar)>,
}

impl Parameter {
    /// Finds a uniform by its name.
    ///
    /// # Errors
    /// No draw has it, or it is not a scalar. The diagnostic has no place.
    pub fn find(scene: &Scene, name: &str) -> Result<Self, Box<Diagnostic>> {
        let mut places = Vec::new();
        let mut trouble = None;
        for (index, draw) in scene.draws.iter().enumerate() {
            match place(&draw.program, name) {
                Ok(Some((root, at, scalar))) => places.push((index, root, at, scalar)),
                Ok(None) => {}
                Err(message) => trouble = Some(message),
            }
        }
        match (places.is_empty(), trouble) {
            (false, _) => Ok(Self { name: name.to_owned(), places }),
            (true, Some(message)) => Err(Box::new(Diagnostic::new(&SCENE_WRONG_KIND, Span::default(), message))),
            (true, None) => Err(Box::new(unknown(scene, name))),
        }
    }

    /// The values of a sweep over it. Those of integers are whole, each of them once.
    ///
    /// # Errors
    /// An end is no value of its type. The diagnostic has the place of the sweep.
    pub fn values(&self, sweep: &Sweep) -> Result<Vec<f64>, Box<Diagnostic>> {
        for &(.., scalar) in &self.places {
            let (name, least, most) = match scalar {
                Scalar::Float => continue,
                Scalar::Bool => ("bool", 0.0, 1.0),
                Scalar::Int => ("int", f64::from(i32::MIN), f64::from(i32::MAX)),
                Scalar::Uint => ("uint", 0.0, f64::from(u32::MAX)),
            };
            let is_value = |end: f64| end.fract() == 0.0 && (least..=most).contains(&end);
            if !is_value(sweep.low) || !is_value(sweep.high) {
                let message = format!("`{}` is declared {name}", self.name);
                let help = format!("both ends of the sweep are whole numbers from {least} to {most}");
                return Err(Box::new(Diagnostic::new(&SCENE_WRONG_KIND, sweep.place, message).here("here").help(help)));
            }
        }
        let mut values = sweep.values();
        if self.places.iter().any(|(.., scalar)| *scalar != Scalar::Float) {
            values.iter_mut().for_each(|value| *value = value.round());
            values.dedup();
        }
        Ok(values)
    }

    /// A number of a uniform by its position in it: a matrix's are column by column.
    pub(super) fn element(scene: &Scene, name: &str, element: usize) -> Option<Self> {
        let mut places = Vec::new();
        for (index, draw) in scene.draws.iter().enumerate() {
            let Some((leaf, array)) = UniformValues::find(&draw.program, name) else { continue };
            let shape = LeafShape::of(&draw.program.types, leaf)?;
            if element < shape.n_each() {
                let at = leaf.flat_offset as usize + array.unwrap_or(0) as usize * shape.n_each() + element;
                places.push((index, leaf.root.0 as usize, at, shape.scalar));
            }
        }
        (!places.is_empty()).then(|| Self { name: name.to_owned(), places })
    }

    /// The scene with another value.
    pub fn set(&self, scene: &mut Scene, value: f64) {
        for &(draw, root, at, scalar) in &self.places {
            let root = scene.draws.get_mut(draw).and_then(|draw| draw.uniforms.get_mut(root));
            if let Some(slot) = root.and_then(|root| root.get_mut(at)) {
                *slot = match scalar {
                    Scalar::Bool => ScalarValue::Bool(value != 0.0),
                    Scalar::Int => ScalarValue::Int(value.round() as i32),
                    Scalar::Uint => ScalarValue::Uint(value.round() as u32),
                    Scalar::Float => ScalarValue::Float(value as f32),
                };
            }
        }
    }

    /// The value in a scene.
    pub fn get(&self, scene: &Scene) -> Option<f64> {
        let &(draw, root, at, _) = self.places.first()?;
        Some(match scene.draws.get(draw)?.uniforms.get(root)?.get(at)? {
            ScalarValue::Bool(value) => f64::from(u8::from(*value)),
            ScalarValue::Int(value) => f64::from(*value),
            ScalarValue::Uint(value) => f64::from(*value),
            ScalarValue::Float(value) => f64::from(*value),
        })
    }

    /// Whether it is the scalar of another one, in any draw.
    fn overlaps(&self, other: &Self) -> bool {
        self.places.iter().any(|place| other.places.contains(place))
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// The uniforms of some sweeps with their values.
///
/// # Errors
/// A sweep is of no uniform, of none with such values, or of the uniform of another one. The diagnostic has its place.
pub fn parameters(scene: &Scene, sweeps: &[Sweep]) -> Result<Vec<(Parameter, Vec<f64>)>, Box<Diagnostic>> {
    let one = |sweep: &Sweep| -> Result<(Parameter, Vec<f64>), Box<Diagnostic>> {
        let found = Parameter::find(scene, &sweep.name).map_err(|mut diagnostic| {
            diagnostic.primary.span = sweep.place;
            Box::new(diagnostic.here("here"))
        })?;
        let values = found.values(sweep)?;
        Ok((found, values))
    };
    let mut found: Vec<(Parameter, Vec<f64>)> = Vec::new();
    for sweep in sweeps {
        let next = one(sweep)?;
        if found.iter().any(|(known, _)| known.overlaps(&next.0)) {
            return Err(Box::new(twice(sweep)));
        }
        found.push(next);
    }
    Ok(found)
}

/// The error for a second range of a uniform.
fn twice(sweep: &Sweep) -> Diagnostic {
    let message = format!("`{}` has two ranges", sweep.name);
    let help = "one range, with as many values as both need";
    Diagnostic::new(&SCENE_WRONG_VALUE, sweep.place, message).here("here").help(help)
}

/// The sweeps that are asked for, and before them those of the scene, unless they are of the same uniforms.
pub fn joined(scene: &Scene, asked: &[Sweep], stated: &[Sweep]) -> Vec<Sweep> {
    let found = |sweep: &Sweep| Parameter::find(scene, &sweep.name).ok();
    let replaced: Vec<Parameter> = asked.iter().filter_map(found).collect();
    let stays = |sweep: &&Sweep| {
        let own = found(sweep);
        !replaced.iter().any(|asked| own.as_ref().is_some_and(|own| own.overlaps(asked)))
    };
    stated.iter().filter(stays).chain(asked).cloned().collect()
}

/// The error for a uniform that no draw has, with the nearest one, or all if they are few.
fn unknown(scene: &Scene, name: &str) -> Diagnostic {
    const MOST_NAMES: usize = 12;
    let uniforms = scene.draws.iter().flat_map(|draw| &draw.program.interface.uniforms);
    let mut names: Vec<&str> = uniforms.map(|leaf| leaf.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let help = match did_you_mean(name, names.iter().copied()) {
        Some(near) => Some(format!("did you mean `{near}`?")),
        None if names.is_empty() => Some("the programs have no uniform at all".to_owned()),
        None if names.len() <= MOST_NAMES => Some(format!("the programs have `{}`", names.join("`, `"))),
        None => None,
    };
    Diagnostic::new(&SCENE_UNKNOWN_NAME, Span::default(), format!("no draw has a uniform `{name}`")).maybe_help(help)
}

/// The root and the position of a scalar in a program; `None` if the program has no such uniform.
fn place(program: &Program, name: &str) -> Result<Option<(usize, usize, Scalar)>, String> {
    let whole = UniformValues::find(program, name).map(|found| (found, None));
    let Some(((leaf, element), part)) = whole.or_else(|| part_of(program, name)) else { return Ok(None) };
    let Some(shape) = LeafShape::of(&program.types, leaf) else {
        return Err(format!("`{name}` is a sampler; a sweep needs a number"));
    };
    let n_each = shape.n_each();
    if leaf.array_size.is_some() && element.is_none() {
        return Err(format!("`{name}` is an array: name an element, `{name}[0]`"));
    }
    let index = match part {
        None if n_each == 1 => 0,
        None if shape.columns > 1 => return Err(format!("`{name}` is a matrix: name a number of it, `{name}[0].x`")),
        None => return Err(format!("`{name}` has {n_each} components: name one, `{name}.x`")),
        Some([column, row]) if n_each > 1 && column < shape.columns as usize && row < shape.rows as usize => {
            column * shape.rows as usize + row
        }
        Some(_) => return Err(format!("`{name}` is not a component of a vector")),
    };
    let element = element.unwrap_or(0) as usize;
    if element >= shape.elements as usize {
        return Err(format!("`{name}` is past the end of the array"));
    }
    Ok(Some((leaf.root.0 as usize, leaf.flat_offset as usize + element * n_each + index, shape.scalar)))
}

/// A leaf, and its element.
type Found<'p> = (&'p UniformLeaf, Option<u32>);

/// The uniform with a component of a vector, or with a column and a row of a matrix: `light.position.x`, `m[1].x`, `m[1][0]`.
fn part_of<'p>(program: &'p Program, name: &str) -> Option<(Found<'p>, Option<[usize; 2]>)> {
    fn indexed(name: &str) -> Option<(&str, usize)> {
        let (base, index) = name.strip_suffix(']')?.rsplit_once('[')?;
        Some((base, index.parse().ok()?))
    }
    let lettered = |name: &'_ str| {
        let (base, component) = name.rsplit_once('.')?;
        Some((base.len(), ["x", "y", "z", "w"].iter().position(|letter| *letter == component)?))
    };
    let (length, row) = match indexed(name) {
        Some((base, row)) => (base.len(), row),
        None => lettered(name)?,
    };
    let base = name.get(..length)?;
    let columns = |found: &Found<'_>| LeafShape::of(&program.types, found.0).map_or(1, |shape| shape.columns);
    if let Some(found) = UniformValues::find(program, base) {
        // A vector has no index here, and a matrix has two.
        return (columns(&found) == 1 && lettered(name).is_some()).then_some((found, Some([0, row])));
    }
    let (base, column) = indexed(base)?;
    let found = UniformValues::find(program, base).filter(|found| columns(found) > 1)?;
    Some((found, Some([column, row])))
}

/// One drawing of a sweep.
#[derive(Clone, Debug, Serialize)]
pub struct SweepPoint {
    /// The values by name.
    pub values: BTreeMap<String, f64>,
    /// The largest finite difference of a channel that is not accepted for the size of the color.
    pub max_abs: f64,
    /// The number of pixels that are not finite in f32.
    pub non_finite_pixels: u64,
}

impl SweepPoint {
    /// The key by which points are compared: pixels that are not finite first, then the error.
    pub fn badness(&self) -> (u64, f64) {
        (self.non_finite_pixels, self.max_abs)
    }

    /// Whether this one is worse.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        let (a, b) = (self.badness(), other.badness());
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).is_gt()
    }

    /// A first verdict, before causes are known: see [`Stability`].
    pub fn verdict(&self, bound: f64) -> Stability {
        match () {
            () if self.non_finite_pixels > 0 => Stability::Broken,
            () if self.max_abs > bound => Stability::Degraded,
            () => Stability::Stable,
        }
    }
}

/// Draws a scene with values in place of its own. Errors up to a share of a color, `relative`, do not count.
///
/// # Errors
/// The errors of drawing.
pub fn point(
    scene: &Scene,
    parameters: &[Parameter],
    values: &[f64],
    relative: f64,
) -> Result<(SweepPoint, Scene), Vec<Diagnostic>> {
    let mut changed = scene.clone();
    for (parameter, value) in parameters.iter().zip(values) {
        parameter.set(&mut changed, *value);
    }
    let pair = pictures_of(&changed)?;
    let errors = pair.errors.beyond(&pair.exact, relative);
    let named = parameters.iter().zip(values).map(|(parameter, value)| (parameter.name.clone(), *value)).collect();
    let max_abs = errors.worst().map_or(0.0, |(_, error)| error);
    Ok((SweepPoint { values: named, max_abs, non_finite_pixels: errors.not_finite() }, changed))
}

/// The drawings of sweeps.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The drawings, in the order of the combinations.
    pub points: Vec<SweepPoint>,
    /// The first of the worst.
    pub worst: SweepPoint,
    /// The scene of that one.
    pub scene: Scene,
}

/// Draws a scene with combinations of values. `progress` is called before each picture but the first, with the number of those
/// drawn and of all; `false` ends the sweep with what it has. What it has is spread over all combinations: both ends, then
/// the middle, then the middles of the halves, and so on.
///
/// # Errors
/// The errors of drawing.
pub fn draw(
    scene: &Scene,
    parameters: &[Parameter],
    combinations: &[Vec<f64>],
    relative: f64,
    progress: &mut dyn FnMut(usize, usize) -> bool,
) -> Result<Drawn, Vec<Diagnostic>> {
    let mut drawn: Vec<(usize, SweepPoint)> = Vec::new();
    for place in spread(combinations.len()) {
        if !drawn.is_empty() && !progress(drawn.len(), combinations.len()) {
            break;
        }
        let values = combinations.get(place).map_or(&[][..], Vec::as_slice);
        drawn.push((place, point(scene, parameters, values, relative)?.0));
    }
    drawn.sort_by_key(|(place, _)| *place);
    let worst = drawn.iter().reduce(|worst, one| if one.1.is_worse_than(&worst.1) { one } else { worst }).cloned();
    let Some((place, worst)) = worst else { return Err(Vec::new()) };
    let mut changed = scene.clone();
    for (parameter, value) in parameters.iter().zip(combinations.get(place).into_iter().flatten()) {
        parameter.set(&mut changed, *value);
    }
    Ok(Drawn { points: drawn.into_iter().map(|(_, point)| point).collect(), worst, scene: changed })
}

/// All numbers below a count: the first, the last, and then those between, by halves.
fn spread(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = [0, count.saturating_sub(1)].into_iter().filter(|place| *place < count).collect();
    order.dedup();
    let mut gaps = std::collections::VecDeque::from([(0, count.saturating_sub(1))]);
    while let Some((low, high)) = gaps.pop_front() {
        if high > low + 1 {
            let middle = low + (high - low) / 2;
            order.push(middle);
            gaps.extend([(low, middle), (middle, high)]);
        }
    }
    order
}

/// All combinations of the values of sweeps, in order: the last one varies first.
///
/// # Errors
/// There are more than [`MOST`].
pub fn combinations(sweeps: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, String> {
    let count = sweeps.iter().fold(1usize, |count, values| count.saturating_mul(values.len()));
    if count > MOST {
        return Err(format!(
            "the sweeps have {count} combinations, and {MOST} is the limit: give smaller counts, NAME=LOW..HIGH:N"
        ));
    }
    let mut all = vec![Vec::new()];
    for values in sweeps {
        all = all
            .iter()
            .flat_map(|start| values.iter().map(move |value| [start.as_slice(), &[*value]].concat()))
            .collect();
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{combinations, parse, spread};

    #[test]
    fn a_sweep_is_read_with_both_ends_among_its_values() {
        let sweep = parse("material.shininess=1..10000:5").expect("it is well-formed");
        assert_eq!((sweep.name.as_str(), sweep.count), ("material.shininess", 5));
        assert_eq!(sweep.values(), [1.0, 10.0, 100.0, 1000.0, 10_000.0]);
        let sweep = parse("t=-1..1e0").expect("it is well-formed");
        assert_eq!((sweep.count, sweep.values()[0], sweep.values()[15]), (16, -1.0, 1.0));
    }

    #[test]
    fn what_is_no_sweep_is_told() {
        for text in ["t", "t=", "t=1", "t=1..", "t=1..x", "t=1..2:1", "t=1..2:0.5", "t=nan..1", "=1..2", "t=1..2:1e9"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn an_order_by_halves_has_every_number_once() {
        assert_eq!(spread(5), [0, 4, 2, 1, 3]);
        for count in 0..40 {
            let mut all = spread(count);
            all.sort_unstable();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn combinations_are_limited() {
        assert_eq!(combinations(&[vec![0.0, 1.0], vec![0.0, 0.5, 1.0]]).map(|all| all.len()), Ok(6));
        assert!(combinations(&[vec![0.0; 100], vec![0.0; 100]]).is_err());
    }
}
