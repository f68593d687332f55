//! [`Weakness`]: the reason why too little of a picture was judged.
//!
//! *In:* the reference's picture and the class of each pixel. *Out:* the class that says too little at most pixels, and the
//! expressions that make the envelope of one of them wide.

use super::Failure;
use super::explain::{Explanations, contributed, excerpt};
use super::runner::Channel;
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::Contribution;
use glisten_scene::compare::evidence::Ruler;
use glisten_scene::compare::{Class, Contributed, Written};
use glisten_scene::picture::{Interval, Picture};
use serde::Serialize;

/// The number of pixels that are examined until one can be explained.
const EXAMINED: usize = 4;

/// Why too little of a picture was judged.
#[derive(Clone, Debug, Serialize)]
pub struct Weakness {
    /// `weak`, `unlimited` or `undecided`: the class of most pixels that were not judged.
    pub class: &'static str,
    /// The number of pixels of that class.
    pub pixels: u64,
    /// The column of an example, from the left.
    pub x: u32,
    /// The row of the example, from the top.
    pub y: u32,
    /// The widest channel of the example.
    pub channel: &'static str,
    /// The width of its envelope; infinite (null) if it has no bound.
    pub width: f64,
    /// The largest contributions to it.
    pub contributions: Vec<Contributed>,
    /// The contributions as an excerpt.
    #[serde(skip)]
    pub note: Option<Diagnostic>,
}

impl Explanations<'_> {
    /// Examines pixels of the class that most of the pixels without evidence have. Nothing covered has no weakness.
    pub(super) fn weakness(
        &mut self,
        picture: &Picture,
        written: &Written,
        classes: &[Option<Class>],
    ) -> Result<Option<Weakness>, Failure> {
        let of = |class: Class| -> Vec<usize> {
            (0..classes.len()).filter(|pixel| classes[*pixel] == Some(class)).collect()
        };
        let candidates =
            [Class::Weak, Class::Unlimited, Class::Undecided, Class::Undefined].map(|class| (class, of(class)));
        let Some((class, pixels)) = candidates.into_iter().max_by_key(|(_, pixels)| pixels.len()) else {
            return Ok(None);
        };
        let ruler = Ruler::new(picture, written, self.options.width);
        let mut found = None;
        for part in 0..EXAMINED {
            let Some(&pixel) = pixels.get((2 * part + 1) * pixels.len() / (2 * EXAMINED)) else { break };
            let (at, width) = widest(picture, written, pixel);
            let contributions = self.contributions(at)?;
            let is_explained = !contributions.is_empty();
            if found.is_none() || is_explained {
                found = Some((at, width, contributions));
            }
            if is_explained {
                break;
            }
        }
        let Some((at, width, contributions)) = found else { return Ok(None) };
        let note = excerpt(&contributions, message(class, at, width, ruler.goal));
        let [x, y] = at.pixel;
        let sources = self.options.sources;
        let place = |one: &Contribution| sources.and_then(|sources| contributed(sources, one));
        Ok(Some(Weakness {
            class: class.name(),
            pixels: pixels.len() as u64,
            x,
            y,
            channel: at.name(),
            width,
            contributions: contributions.iter().filter_map(place).collect(),
            note,
        }))
    }
}

/// The widest written channel of a pixel, and its width.
fn widest(picture: &Picture, written: &Written, pixel: usize) -> (Channel, f64) {
    let columns = (picture.width as usize).max(1);
    let place = [(pixel % columns) as u32, (pixel / columns) as u32];
    let mut found = (Channel { pixel: place, attachment: 0, channel: 0 }, -1.0);
    for (attachment, colors) in picture.intervals.iter().flatten().enumerate() {
        for (channel, interval) in colors.get(pixel).into_iter().flatten().enumerate() {
            let width = Interval::width(*interval);
            if written.is_written(attachment, channel) && width > found.1 {
                let (attachment, channel) = (attachment as u32, channel as u32);
                found = (Channel { pixel: place, attachment, channel }, width);
            }
        }
    }
    (found.0, found.1.max(0.0))
}

fn message(class: Class, at: Channel, width: f64, goal: f64) -> String {
    let ([x, y], channel) = (at.pixel, at.name());
    match class {
        Class::Undecided => format!("what keeps pixel ({x}, {y}) undecided, by the bound of {channel}"),
        _ if width.is_finite() => format!(
            "why {channel} at pixel ({x}, {y}) is not judged: its envelope is {width:.2e} wide, the goal is {goal:.2e}"
        ),
        _ => format!("why {channel} at pixel ({x}, {y}) is not judged: its envelope has no bound"),
    }
}
