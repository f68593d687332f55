//! The page as HTML.

use super::listing::{Section, listing, version_note};
use glisten_front::hir::Stage;
use glisten_front::source::SourceMap;
use glisten_page::raster::{Decades, color_uri, difference_uri};
use glisten_page::words::grouped;
use glisten_page::{Page, Place, View, viewer};
use glisten_scene::picture::{Encoding, Picture};
use glisten_scene::{Draw, Scene};
use glisten_verify::specialize::{
    Account, DrawAccount, Figures, Math, PictureError, Pictures, SpecializedDraw, SpecializedScene,
};
use minijinja::{Value, context};

const PAGE: Page = Page {
    templates: &[("account.html", include_str!("page.html")), ("row.html", include_str!("row.html"))],
    styles: &[include_str!("page.css")],
    scripts: &[],
};

/// A scene on the page.
pub struct SceneOnPage<'a> {
    /// The account.
    pub account: &'a Account,
    /// The original.
    pub scene: &'a Scene,
    /// The texts that the original was read from.
    pub sources: &'a SourceMap,
    /// The residual.
    pub specialized: &'a SpecializedScene,
    /// The pictures of both on the reference in f32.
    pub pictures: &'a Pictures,
}

/// The page of these scenes.
///
/// # Errors
/// The message of the template engine, which only a broken template causes.
pub fn page(scenes: &[SceneOnPage<'_>]) -> Result<String, String> {
    let several = scenes.len() > 1;
    let scenes: Vec<Value> = scenes.iter().map(scene).collect();
    let values = context! { scenes, several, version => env!("CARGO_PKG_VERSION") };
    PAGE.render(values).map_err(|error| error.to_string())
}

fn scene(one: &SceneOnPage<'_>) -> Value {
    let error = one.account.error();
    let draws = one.account.draws.iter().zip(&one.scene.draws).zip(&one.specialized.draws);
    let draws: Vec<Value> = draws.map(|((account, draw), done)| self::draw(account, draw, done, one.sources)).collect();
    context! {
        name => &one.account.scene,
        viewer => viewer(None, &views(one.pictures, one.scene.framebuffer.encode)),
        allowed => match one.specialized.contract.math {
            Math::Finite => "Every number was taken to be finite.",
            Math::Exact | Math::Fast => "Rounding was allowed to change.",
        },
        error => error.map(|error| self::error(&error)),
        several_draws => draws.len() > 1,
        draws,
    }
}

/// The pictures: both and their difference, or one if they are the same.
fn views(Pictures { original, residual }: &Pictures, encode: Encoding) -> Vec<View> {
    let size = [original.width, original.height];
    let differing = original.bit_unequal(residual);
    let color = |picture: &Picture| Some((color_uri(picture, encode), size));
    if differing == 0 {
        let caption = "<strong>Original and residual</strong>: every bit of every pixel is the same.";
        return vec![View::new(Place::First, "both", caption, color(original))];
    }
    let map = difference_uri(&differences(residual, original), size[0], size[1], Decades::ALL);
    let count =
        if differing == 1 { "1 pixel differs".to_owned() } else { format!("{} pixels differ", grouped(differing)) };
    let caption =
        format!("<strong>Difference</strong>: {count}, from black (none) to yellow (1) on a logarithmic scale.");
    vec![
        View::new(Place::First, "residual", "<strong>Residual</strong>", color(residual)),
        View::new(Place::Second, "original", "<strong>Original</strong>", color(original)),
        View::new(Place::Third, "difference", caption, Some((map, size))),
    ]
}

fn error(error: &PictureError) -> Value {
    context! {
        max_abs => scientific(error.max_abs),
        rmse => scientific(error.rmse),
        before => scientific(error.original.max_abs),
        after => scientific(error.residual.max_abs),
        exact => scientific(error.exact.max_abs),
        non_finite => error.non_finite,
        coverage_mismatch => error.coverage_mismatch,
    }
}

fn scientific(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.2e}") }
}

/// The largest difference of each pixel over all attachments; nothing where only one picture covers it.
fn differences(picture: &Picture, truth: &Picture) -> Vec<Option<f64>> {
    let covered = picture.covered.iter().zip(&truth.covered);
    covered
        .enumerate()
        .map(|(pixel, (a, b))| {
            let attachments = picture.attachments.iter().zip(&truth.attachments);
            let channels = attachments.filter_map(|(a, b)| Some((a.get(pixel)?, b.get(pixel)?)));
            let largest = channels.flat_map(|(a, b)| a.iter().zip(b)).fold(0.0, |largest: f64, (a, b)| {
                let same = a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
                let difference = if same { 0.0 } else { (a - b).abs() };
                largest.max(if difference.is_finite() { difference } else { 1.0 })
            });
            (a == b).then_some(largest)
        })
        .collect()
}

fn draw(account: &DrawAccount, draw: &Draw, done: &SpecializedDraw, sources: &SourceMap) -> Value {
    let stages: Vec<Value> = [Stage::Vertex, Stage::Fragment]
        .into_iter()
        .map(|stage| {
            let sections: Vec<Value> = listing(&draw.program, stage, done, sources).iter().map(section).collect();
            context! { name => stage.name(), sections, version => version_note(&draw.program, stage, done, sources) }
        })
        .collect();
    let left_out: Vec<Value> = account
        .left_out
        .iter()
        .map(|one| context! { what => one.what, name => &one.name, line => one.line, because => &one.because })
        .collect();
    let moves = account.move_to_vertex.iter().flat_map(|moves| &moves.moved);
    let moved: Vec<Value> = moves.map(|one| context! { name => &one.name, expression => &one.expression }).collect();
    context! {
        vertex => &account.vertex,
        fragment => &account.fragment,
        residual => &account.residual,
        left_out,
        moved,
        figures => figures(&account.before, &account.after),
        stages,
    }
}

fn section(section: &Section) -> Value {
    let rows: Vec<Value> = section
        .rows
        .iter()
        .map(|row| {
            let safe = |text: &Option<String>| text.clone().map(Value::from_safe_string);
            context! {
                class => row.class,
                number => row.number,
                left => safe(&row.left),
                right => safe(&row.right),
                because => &row.because,
                first => row.first,
            }
        })
        .collect();
    context! { title => &section.title, place => &section.place, gone => &section.gone, rows }
}

/// A change in percent. One that rounds to nothing is told as what it is: small.
fn percent(share: f64) -> String {
    let sign = if share < 0.0 { "\u{2212}" } else { "+" };
    match share.abs() * 100.0 {
        size if size < 0.1 => format!("under 0.1 % {}", if share < 0.0 { "less" } else { "more" }),
        size if size < 1.0 => format!("{sign}{size:.1} %"),
        size => format!("{sign}{size:.0} %"),
    }
}

/// The figures, a line each: the name, before, after, and the change.
fn figures(before: &Figures, after: &Figures) -> Vec<Value> {
    let lines = [
        ("SPIR-V instructions", before.spirv_instructions, after.spirv_instructions),
        ("Vertex operations, without those on integers", before.vertex_operations, after.vertex_operations),
        ("Fragment operations, without those on integers", before.fragment_operations, after.fragment_operations),
        ("Varyings", before.varyings, after.varyings),
        ("Attributes", before.attributes, after.attributes),
        ("Bytes of attributes", before.attribute_bytes, after.attribute_bytes),
        ("Bytes of uniforms", before.uniform_bytes, after.uniform_bytes),
        ("Textures", before.textures, after.textures),
    ];
    lines
        .into_iter()
        .map(|(name, before, after)| {
            let change = match (before, after) {
                (before, after) if before == after => "as before".to_owned(),
                (0, _) => "new".to_owned(),
                (before, after) => percent(after as f64 / before as f64 - 1.0),
            };
            context! { name, before => grouped(before), after => grouped(after), change, less => after < before }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn no_change_is_minus_nothing() {
        let shares = [-0.5, -0.004, -0.0004, 0.25, 1.5];
        let texts = ["\u{2212}50 %", "\u{2212}0.4 %", "under 0.1 % less", "+25 %", "+150 %"];
        assert_eq!(shares.map(percent), texts);
    }
}
