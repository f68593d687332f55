//! `render`: the picture that the reference draws of a scene.

use crate::reply::Reply;
use crate::request::Request;
use glisten_binding::{Error, Files, Format, Precision, Scenery};
use std::sync::Arc;

/// Answers `render`: the pixels of each attachment as bytes, or as doubles.
pub(crate) fn render(request: &Request, blob: &[u8]) -> Result<Reply, Error> {
    let (settings, asked) = request.settings()?;
    let precision = match request.to.as_str() {
        "" | "f64" => Precision::F64,
        "f32" => Precision::F32,
        other => return Err(Error::argument(format!("`{other}` is no precision: f64, f32"))),
    };
    let files = Files::of(Arc::new(request.files(blob)?));
    let scene = Scenery::load(&settings, &request.path, &files)?;
    let mut reply = Reply::default();
    if let Some(wanted) = asked.wanted() {
        reply.set("wanted", wanted);
        return Ok(reply);
    }
    reply.set("sound", scene.is_sound());
    reply.set("diagnostics", scene.diagnostics(Format::Json));
    reply.set("human", scene.diagnostics(Format::Human));
    if !scene.is_sound() {
        return Ok(reply);
    }
    let drawn = scene.draw(precision)?;
    reply.set("width", drawn.width);
    reply.set("height", drawn.height);
    let mut attachments = Vec::new();
    for pixels in &drawn.attachments {
        let channels = pixels.as_flattened().iter();
        let bytes: Vec<u8> = match request.floats {
            true => channels.flat_map(|channel| channel.to_le_bytes()).collect(),
            false => channels.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8).collect(),
        };
        attachments.push(reply.bytes(&bytes));
    }
    reply.set("attachments", attachments);
    let covered: Vec<u8> = drawn.covered.iter().map(|covered| u8::from(*covered)).collect();
    let covered = reply.bytes(&covered);
    reply.set("covered", covered);
    Ok(reply)
}
