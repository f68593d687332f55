//! [`Expected`]: the reference's picture of a scene, and the verdict on another picture of it.
//!
//! *In:* a scene and [`Options`]. *Out:* the reference's picture; verdicts.
//! *Holds:* the reference draws once. It draws again with known faults excused only if a picture needs an excuse. A few
//! simulated GPUs draw as well; many do only where a picture is suspect by the few.

use super::clock::Clock;
use super::{Failure, Options, part};
use crate::scene::Scene;
use glisten_reference::domain::Gpu;
use glisten_reference::domain::faults::Faults;
use glisten_reference::{RenderOptions, Sample, Undefined, faults_of, hides_undefined};
use glisten_scene::compare::evidence::Ruler;
use glisten_scene::compare::population::{MIN_MEMBERS, MIN_PIXELS, MIN_SHARE};
use glisten_scene::compare::{Class, Compared, Comparison, Criterion, Gauge, Population, Verdict, Written};
use glisten_scene::picture::Picture;

/// The seed of the population, the same for every scene.
pub const POPULATION_SEED: u64 = 1;
/// An envelope is narrow up to this share of the goal for evidence: 1/4080 of the range of the picture's values. Where
/// all are, a population would find nothing.
const NARROW: f64 = 1.0 / 16.0;
/// The numbers of simulated GPUs that a picture is compared with if its envelopes leave room: each only if it is suspect by
/// fewer. More of them never make a picture suspect, because they widen what is likely.
const MEMBERS: [u32; 5] = [2, 4, 8, 16, 32];
/// The numbers of simulated GPUs where envelopes are too wide to judge by, so that the population is the evidence. At first
/// most of them draw the pixels alone that they have to judge; if the picture is suspect then, they draw everything.
const WITNESSES: [u32; 3] = [MIN_MEMBERS, MIN_MEMBERS, 2 * MIN_MEMBERS];
/// How many of them draw everything in any case.
const FIRST: u32 = 2;
/// The share of the pixels that nothing else judges in which a picture has to agree with the device's known arithmetic.
const DEVICE_SHARE: f64 = 0.95;
/// The share of the picture up to which drawing a part of it pays.
const PART: f64 = 0.5;

/// The picture of the reference, with which others are compared. For pictures that no [`Runner`](super::Runner) drew.
pub struct Expected<'a> {
    scene: &'a Scene,
    options: &'a Options<'a>,
    /// The part of the picture that is judged.
    sample: Sample,
    picture: Picture,
    milliseconds: f64,
    written: Written,
    likely_margin: f64,
    population: Option<Population>,
    /// The pixels of the pictures so far that a known fault explains; they measure nothing of a picture as a whole.
    left_out: Vec<bool>,
    /// The places that the language leaves undefined; found on demand.
    undefined: Option<Option<Undefined>>,
    /// The picture that the device draws by its known arithmetic, while a picture is compared that agrees with it.
    device: Option<Picture>,
    /// The picture with each known fault excused alone, and with all of them; drawn on demand.
    excused: Option<Vec<(&'static str, Picture)>>,
}

impl<'a> Expected<'a> {
    /// Draws the scene by the reference.
    ///
    /// # Errors
    /// The reference cannot draw it.
    pub fn new(scene: &'a Scene, options: &'a Options<'a>) -> Result<Self, Failure> {
        let clock = Clock::start();
        let sample = part::part(scene, options)?;
        let drawn = RenderOptions { sample, ..options.reference_options(Faults::NONE) };
        let mut picture = options.reference.render(scene, &drawn)?;
        part::keep_only(&mut picture, sample);
        let milliseconds = clock.milliseconds();
        Ok(Self {
            scene,
            options,
            sample,
            picture,
            milliseconds,
            written: Written::of(scene),
            likely_margin: options.likely_margin,
            population: None,
            left_out: Vec::new(),
            undefined: None,
            device: None,
            excused: None,
        })
    }

    /// The part of the picture that is judged.
    pub fn sample(&self) -> Sample {
        self.sample
    }

    /// The options with which the reference draws.
    fn drawn_by(&self, faults: Faults) -> RenderOptions {
        RenderOptions { sample: self.sample, ..self.options.reference_options(faults) }
    }

    /// The channels that the scene's programs write.
    pub(super) fn written(&self) -> &Written {
        &self.written
    }

    /// The reference's picture with its envelope.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// The reference's picture, and its time in milliseconds.
    pub(super) fn into_picture(self) -> (Picture, f64) {
        (self.picture, self.milliseconds)
    }

    /// Replaces [`Options::likely_margin`] for the pictures that follow.
    pub fn set_likely_margin(&mut self, margin: f64) {
        self.likely_margin = margin;
    }

    /// Compares a picture of the scene with the reference.
    ///
    /// # Errors
    /// The reference cannot draw the scene with a fault excused.
    pub fn compare(&mut self, picture: &Picture) -> Result<Verdict, Failure> {
        Ok(self.compared(picture)?.verdict)
    }

    /// Compares a picture of the scene with the reference, and tells the class of each pixel.
    ///
    /// # Errors
    /// The reference cannot draw the scene with a fault excused.
    pub fn compared(&mut self, picture: &Picture) -> Result<Compared, Failure> {
        let picture = &*part::only(picture, self.sample, &self.picture);
        let Options { criterion, excuse_known_faults, .. } = *self.options;
        let is_by_envelope = criterion == Criterion::Envelope;
        let mut compared = self.comparison(&[]).compare(picture, &self.picture);
        if is_by_envelope && self.needs_undefined(&compared.verdict)? && self.find_undefined()? {
            compared = self.comparison(&[]).compare(picture, &self.picture);
        }
        let mut excused = Vec::new();
        if is_by_envelope && excuse_known_faults && compared.verdict.needs_excuse() {
            excused = match self.excused.take() {
                Some(excused) => excused,
                None => self.draw_excused()?,
            };
            compared = self.comparison(&excused).compare(picture, &self.picture);
            self.leave_out(&compared.classes);
        }
        if is_by_envelope && self.options.demands.likely {
            if !compared.verdict.needs_excuse() && self.leaves_room() {
                let is_evidence = lacks_evidence(&compared.verdict);
                let numbers: &[u32] = if is_evidence { &WITNESSES } else { &MEMBERS };
                for members in numbers.iter().copied() {
                    if compared.verdict.suspect.is_none() || compared.verdict.is_suspect() {
                        self.populate(members, is_evidence)?;
                        compared = self.comparison(&excused).compare(picture, &self.picture);
                    }
                }
            }
            compared.verdict.suspect.get_or_insert(0);
            if self.options.as_device
                && self.options.profile.straight_levels
                && !compared.verdict.needs_excuse()
                && !compared.verdict.is_suspect()
                && lacks_evidence(&compared.verdict)
                && self.find_device(picture, &compared.classes)?
            {
                compared = self.comparison(&excused).compare(picture, &self.picture);
                self.device = None;
            }
        }
        if !excused.is_empty() {
            self.excused = Some(excused);
        }
        Ok(compared)
    }

    /// Leaves excused pixels out of whole pictures. Members of a population that was measured with them are drawn again when
    /// they are asked.
    fn leave_out(&mut self, classes: &[Option<Class>]) {
        self.left_out.resize(self.picture.covered.len(), false);
        for (left_out, class) in self.left_out.iter_mut().zip(classes) {
            if *class == Some(Class::Excused) && !*left_out {
                *left_out = true;
                self.population = None;
            }
        }
    }

    /// Whether something undefined could change the verdict.
    fn needs_undefined(&self, verdict: &Verdict) -> Result<bool, Failure> {
        let is_sure = !verdict.needs_excuse() && verdict.undecided == 0 && verdict.evidence.good() == verdict.covered;
        Ok(self.undefined.is_none() && (!is_sure || hides_undefined(self.scene)?))
    }

    /// Looks for what the language leaves undefined. Returns whether there is something.
    fn find_undefined(&mut self) -> Result<bool, Failure> {
        let found = self.options.reference.undefined(self.scene, &self.drawn_by(Faults::NONE))?;
        let is_there = found.is_some();
        self.undefined = Some(found);
        Ok(is_there)
    }

    /// Looks for the picture that this device draws by what is known of its arithmetic, if it agrees with `picture` where nothing
    /// else judges it. Returns whether there is one.
    fn find_device(&mut self, picture: &Picture, classes: &[Option<Class>]) -> Result<bool, Failure> {
        let is_open = |class: &Option<Class>| matches!(class, Some(Class::Weak | Class::Unlimited | Class::Undecided));
        let places: Vec<bool> = classes.iter().map(is_open).collect();
        let count = places.iter().filter(|place| **place).count();
        let options = self.drawn_by(Faults::NONE);
        for number in 0..Gpu::LLVMPIPES {
            let drawn = self.options.reference.as_llvmpipe(self.scene, &options, number, &places)?;
            let ruler = Ruler::new(&self.picture, &self.written, self.options.width);
            let agrees = |pixel: &usize| places.get(*pixel) == Some(&true) && ruler.agree(picture, &drawn, *pixel);
            let agreeing = (0..places.len()).filter(agrees).count();
            if agreeing as f64 >= DEVICE_SHARE * count as f64 {
                self.device = Some(drawn);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The places in the picture that the language leaves undefined.
    pub(super) fn undefined(&self) -> Option<&Undefined> {
        self.undefined.as_ref()?.as_ref()
    }

    /// Whether the envelopes leave room in which a fault may hide: enough of them are wider than [`NARROW`].
    fn leaves_room(&self) -> bool {
        let ruler = Ruler::new(&self.picture, &self.written, self.options.width);
        let covered = (0..self.picture.covered.len()).filter(|pixel| self.picture.covered.get(*pixel) == Some(&true));
        let (count, wide) = covered.fold((0_u64, 0_u64), |(count, wide), pixel| {
            let is_wide = ruler.width(pixel) > ruler.goal * NARROW;
            (count + 1, wide + u64::from(is_wide))
        });
        let open = self.picture.undecided.iter().filter(|open| **open).count() as u64;
        (wide + open) as f64 > MIN_SHARE * count as f64
    }

    /// Draws with more simulated GPUs, so that there are `members`. If they are the evidence, the first time most of them
    /// draw what the envelopes do not judge.
    fn populate(&mut self, members: u32, is_evidence: bool) -> Result<(), Failure> {
        self.population = Some(match self.population.take() {
            None if is_evidence => {
                let few = self.grown(self.blank(), FIRST)?;
                match self.to_judge() {
                    Some(places) => self.grown(few.restricted_to(places), members)?,
                    None => self.grown(few, members)?,
                }
            }
            None => self.grown(self.blank(), members)?,
            Some(part) if part.places().is_some() => self.grown(self.blank(), members.max(part.members))?,
            Some(population) => self.grown(population, members)?,
        });
        Ok(())
    }

    fn grown(&self, population: Population, members: u32) -> Result<Population, Failure> {
        let missing = population.members..members.max(population.members);
        let options = self.drawn_by(Faults::NONE);
        self.options.reference.populate(population, self.scene, &options, missing)
    }

    /// The pixels that the envelopes do not judge, and those around them; `None` if they are most of the picture.
    fn to_judge(&self) -> Option<Vec<bool>> {
        let ruler = Ruler::new(&self.picture, &self.written, self.options.width);
        let (width, height) = (self.picture.width as usize, self.picture.height as usize);
        let mut places = vec![false; width * height];
        for pixel in 0..places.len() {
            let is_open = self.picture.undecided.get(pixel) == Some(&true);
            let is_covered = self.picture.covered.get(pixel) == Some(&true);
            let is_judged = matches!(ruler.class(pixel), Class::Judged | Class::Edge);
            if !is_open && (!is_covered || is_judged) {
                continue;
            }
            let (x, y) = (pixel % width, pixel / width);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                let columns = row * width + x.saturating_sub(1)..row * width + (x + 2).min(width);
                places.get_mut(columns).into_iter().for_each(|places| places.fill(true));
            }
        }
        let count = places.iter().filter(|place| **place).count();
        (count as f64 <= PART * places.len() as f64).then_some(places)
    }

    /// A population without members.
    fn blank(&self) -> Population {
        let Picture { width, height, .. } = self.picture;
        let mut without = self.left_out.clone();
        if let Some(undefined) = self.undefined() {
            without.resize(self.picture.covered.len(), false);
            without.iter_mut().zip(&undefined.pixels).for_each(|(without, undefined)| *without |= undefined);
        }
        let ruler = Ruler::new(&self.picture, &self.written, self.options.width).without(&without);
        Population::new(POPULATION_SEED, [width, height], self.picture.attachments.len() as u32)
            .with_gauge(Gauge::new(&ruler))
    }

    fn comparison<'j>(&'j self, faults: &'j [(&'static str, Picture)]) -> Comparison<'j> {
        let (Options { criterion, width, .. }, likely_margin) = (*self.options, self.likely_margin);
        Comparison {
            criterion,
            faults,
            written: Some(&self.written),
            width,
            population: self.population.as_ref(),
            likely_margin,
            device: self.device.as_ref(),
            undefined: self.undefined().map_or(&[], |undefined| &undefined.pixels),
        }
    }

    /// One picture for each known fault that can show in the scene; and one with all of them, if there are several.
    fn draw_excused(&self) -> Result<Vec<(&'static str, Picture)>, Failure> {
        let known = faults_of(self.scene);
        let one = known.iter().map(|known| (known.name, Faults::only(known.fault)));
        let named = one.chain((known.len() > 1).then(|| ("several", Faults::all())));
        let (names, options): (Vec<_>, Vec<_>) = named.map(|(name, faults)| (name, self.drawn_by(faults))).unzip();
        Ok(names.into_iter().zip(self.options.reference.render_all(self.scene, &options)?).collect())
    }
}

/// Whether so many pixels have a wide envelope that the population has to judge.
fn lacks_evidence(verdict: &Verdict) -> bool {
    let open = verdict.covered.saturating_sub(verdict.evidence.good() + verdict.evidence.undefined);
    open >= MIN_PIXELS && open as f64 > MIN_SHARE * verdict.covered as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{DiskFiles, load};
    use glisten_front::{Compiler, Options as CompilerOptions};

    const FAULTY: &str =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/core/behind_the_eye_noperspective.toml");

    /// The pixels inside of which a number is explained by the fault alone, with that number, in red.
    fn explained(expected: &Expected<'_>, scene: &Scene) -> Vec<(usize, f64)> {
        let options = expected.options;
        let faulty =
            options.reference.render(scene, &options.reference_options(Faults::all())).expect("it can be drawn");
        let picture = expected.picture();
        let strict = picture.intervals.as_ref().expect("it has envelopes");
        let wide = faulty.intervals.expect("it has envelopes");
        let inside = |pixel: &usize| picture.covered[*pixel] && !picture.near_edge[*pixel];
        let excused = |pixel: usize| {
            let (strict, wide) = (strict[0][pixel][0], wide[0][pixel][0]);
            let red = picture.attachments[0][pixel][0];
            let numbers = [red + 0.25, wide.low, wide.high, f64::NAN].into_iter();
            let mut found = numbers.filter(|number| wide.contains(*number) && !strict.contains(*number));
            found.next().map(|number| (pixel, number))
        };
        (0..strict[0].len()).filter(inside).filter_map(excused).collect()
    }

    #[test]
    fn a_picture_with_many_excused_pixels_is_not_far_as_a_whole() {
        let scene = load(FAULTY, &DiskFiles, &Compiler::new(CompilerOptions::default())).scene.expect("a fixture");
        let options = Options::default();
        let mut expected = Expected::new(&scene, &options).expect("it can be drawn");
        let excused = explained(&expected, &scene);
        // All that is not excused is as the reference has it.
        let mut picture = expected.picture().clone();
        excused.iter().for_each(|(pixel, number)| picture.attachments[0][*pixel][0] = *number);
        let verdict = expected.compare(&picture).expect("it can be drawn");
        assert!(verdict.evidence.excused * 10 > verdict.covered, "{verdict:?}");
        assert_eq!((verdict.suspect, verdict.needs_excuse()), (Some(0), false), "{verdict:?}");
        assert_eq!(verdict.conclusion(&options.demands), glisten_scene::compare::Conclusion::Holds);
    }

    #[test]
    fn a_picture_with_an_excused_pixel_is_compared_with_the_population() {
        let scene = load(FAULTY, &DiskFiles, &Compiler::new(CompilerOptions::default())).scene.expect("a fixture");
        let options = Options::default();
        let mut expected = Expected::new(&scene, &options).expect("it can be drawn");
        // One number that only the fault explains.
        let (pixel, number) = *explained(&expected, &scene).first().expect("the fault shows");
        let mut picture = expected.picture().clone();
        let strict = picture.intervals.clone().expect("it has envelopes");
        picture.attachments[0][pixel][0] = number;
        let verdict = expected.compare(&picture).expect("it can be drawn");
        assert_eq!(verdict.known_faults.iter().map(|fault| fault.pixels).sum::<u64>(), 1, "{verdict:?}");
        assert_eq!((verdict.suspect, verdict.needs_excuse()), (Some(0), false));
        // And where all is far from what they draw, an excused pixel hides nothing.
        for (color, intervals) in picture.attachments[0].iter_mut().zip(&strict[0]).skip(pixel + 1) {
            *color = std::array::from_fn(|channel| intervals[channel].low.max(color[channel] - 1e-3));
        }
        let verdict = expected.compare(&picture).expect("it can be drawn");
        assert_eq!(verdict.known_faults.len(), 1);
        assert!(expected.population.is_some() == expected.leaves_room());
        assert!(verdict.suspect.is_some(), "{verdict:?}");
    }
}
