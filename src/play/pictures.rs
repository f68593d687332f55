//! [`Pictures`]: the pictures that were drawn last, for questions about single pixels.
//!
//! *In:* scenes, and pictures that a driver drew. *Out:* pictures as data URIs, the numbers of a pixel. *Holds:* colors are encoded as
//! `glisten render` does.

use super::told;
use crate::scene::Scene;
use glisten_reference::{LineRule, Precision, RenderOptions, Sample};
use glisten_scene::picture::{Picture, color_uri};
use serde_json::{Value, json};

/// The side of the blocks of a first look, in pixels: since quads of pixels are drawn, it takes a sixteenth of the whole picture's time.
const BLOCK: u32 = 8;

/// The pictures that were drawn last.
#[derive(Default)]
pub struct Pictures {
    reference: Option<Picture>,
    driver: Option<Picture>,
    /// For each pixel the difference as a share of its bound.
    shares: Vec<f64>,
}

impl Pictures {
    /// Draws by the reference, in f64.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub fn reference(&mut self, scene: &Scene) -> Result<Value, String> {
        let (picture, drawn) = by_reference(scene, Sample::ALL)?;
        (self.reference, self.driver, self.shares) = (Some(picture), None, Vec::new());
        Ok(drawn)
    }

    /// Draws one pixel of each block by the reference, which stands for all of it. No pixel has numbers then.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub fn first_look(&mut self, scene: &Scene) -> Result<Value, String> {
        let (_, mut drawn) = by_reference(scene, Sample::lattice(BLOCK))?;
        drawn["block"] = BLOCK.into();
        *self = Self::default();
        Ok(drawn)
    }

    /// Takes what a driver drew.
    pub fn take_driver(&mut self, picture: Picture) {
        self.driver = Some(picture);
    }

    /// Takes two pictures that were compared, with the difference of each pixel as a share of its bound.
    pub fn take_judged(&mut self, reference: Picture, driver: Option<Picture>, shares: Vec<f64>) {
        (self.reference, self.driver, self.shares) = (Some(reference), driver, shares);
    }

    /// The numbers of a pixel.
    pub fn pixel(&self, x: u32, y: u32) -> Value {
        let value = |picture: &Option<Picture>| picture.as_ref().and_then(|picture| pixel(picture, x, y));
        let share = self.reference.as_ref().and_then(|picture| {
            let index = index(picture, x, y)?;
            self.shares.get(index).copied().filter(|share| share.is_finite())
        });
        json!({ "x": x, "y": y, "reference": value(&self.reference), "driver": value(&self.driver), "share": share })
    }
}

fn by_reference(scene: &Scene, sample: Sample) -> Result<(Picture, Value), String> {
    let options = RenderOptions {
        precision: Precision::F64,
        lines: LineRule::OpenGl,
        mark_edges: false,
        sample,
        ..RenderOptions::default()
    };
    let mut picture = glisten_reference::render(scene, &options).map_err(|errors| told(&errors))?;
    sample.spread(&mut picture);
    let drawn = drawn(&picture, scene, "the reference, in f64");
    Ok((picture, drawn))
}

/// A picture for the page, and who drew it.
pub fn drawn(picture: &Picture, scene: &Scene, by: &str) -> Value {
    json!({
        "picture": color_uri(picture, scene.framebuffer.encode),
        "width": picture.width,
        "height": picture.height,
        "by": by,
        "is_empty": !picture.covered.contains(&true),
    })
}

fn index(picture: &Picture, x: u32, y: u32) -> Option<usize> {
    (x < picture.width && y < picture.height).then(|| y as usize * picture.width as usize + x as usize)
}

/// The numbers of a covered pixel, as text, so that those that are not finite can be told.
fn pixel(picture: &Picture, x: u32, y: u32) -> Option<Value> {
    let index = index(picture, x, y)?;
    let values = picture.attachments.first()?.get(index)?;
    let texts: Vec<String> = values.iter().map(|value| format!("{value:.7}")).collect();
    Some(json!({ "values": texts, "is_covered": picture.covered.get(index) }))
}
