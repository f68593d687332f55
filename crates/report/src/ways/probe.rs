//! The range of an expression over a picture.
//!
//! *In:* a draw of a scene and a scalar expression of its fragment stage. *Out:* the least and the greatest value that the
//! expression has in a visible fragment, in f64. *Holds:* the reference draws the picture once with a program that writes
//! both in place of its color; a fragment that does not compute the expression counts for nothing.

use super::edit::Edited;
use glisten_front::hir::{ExprId, Storage, TypeId};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::{Format, Scene};

/// No number of a picture is as large.
const BEYOND: f64 = 1e38;

/// The range of an expression of the fragment stage of draw `index`; `None` if no fragment computes it, if it is not
/// finite somewhere, or if the reference cannot draw the scene.
pub(super) fn range(scene: &Scene, index: usize, id: ExprId) -> Option<[f64; 2]> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    watch(&mut edited, id)?;
    let mut probe = edited.draw(draw)?;
    probe.state.blend = None;
    let mut framebuffer = scene.framebuffer;
    (framebuffer.format, framebuffer.attachments, framebuffer.clear) = (Format::Rgba32Float, 1, [0.0; 4]);
    let scene = Scene { name: scene.name.clone(), framebuffer, draws: vec![probe] };
    let options = RenderOptions { precision: Precision::F64, mark_edges: false, ..RenderOptions::default() };
    let picture = render(&scene, &options).ok()?;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (pixel, covered) in picture.attachments.first()?.iter().zip(&picture.covered) {
        let [least, greatest, strange, _] = *pixel;
        if !covered || (least > greatest && strange == 0.0) {
            continue;
        }
        if strange != 0.0 || least.abs() > BEYOND || greatest.abs() > BEYOND {
            return None;
        }
        (low, high) = (low.min(least), high.max(greatest));
    }
    (low <= high).then_some([low, high])
}

/// Makes the fragment stage write the range of an expression.
fn watch(edited: &mut Edited, id: ExprId) -> Option<()> {
    let types = edited.types.clone();
    let stage = &mut edited.fragment;
    let [function, least, greatest, strange, output] =
        ["watched", "least", "greatest", "strange", "watched_range"].map(|name| stage.fresh(&types, name));
    let body = stage.renamed_main(&types, "watched_main")?;
    // The outputs of old are variables like others.
    let names: Vec<String> =
        (0..stage.shader.globals.len()).map(|one| stage.fresh(&types, &format!("old_{one}"))).collect();
    for (global, name) in stage.shader.globals.iter_mut().zip(names) {
        if global.storage == Storage::Out {
            (global.storage, global.location, global.index, global.invariant) = (Storage::Private, None, None, false);
            global.interpolation_written = false;
            if global.builtin.take().is_some() {
                global.name = name;
            }
        }
    }
    let callee = stage.prototype(&function, TypeId::FLOAT, &[TypeId::FLOAT]);
    let inner = stage.copied(id);
    stage.replace(id, callee, vec![inner]);
    stage.appended.push_str(&format!(
        "\nfloat {least};\nfloat {greatest};\nfloat {strange};\nout vec4 {output};\n\n\
         float {function}(float x) {{\n    if (!(abs(x) <= 1e38)) {strange} = 1.0;\n    {least} = min({least}, x);\n    \
         {greatest} = max({greatest}, x);\n    return x;\n}}\n\n\
         void main() {{\n    {least} = 1e38;\n    {greatest} = -1e38;\n    {strange} = 0.0;\n    {body}();\n    \
         {output} = vec4({least}, {greatest}, {strange}, 1.0);\n}}\n"
    ));
    Some(())
}
