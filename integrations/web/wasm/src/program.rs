//! `compile`: code of each stage for each target, the reflection, and what is wrong.

use crate::reply::Reply;
use crate::request::Request;
use glisten_binding::{Compiled, Error, Format, target_of_word};
use serde_json::{Map, Value};

/// Answers `compile`. With errors in the sources there is no code.
pub(crate) fn compile(request: &Request) -> Result<Reply, Error> {
    let (settings, asked) = request.settings()?;
    let compiled = glisten_binding::compile(&settings, &request.sources()?, request.lints)?;
    let mut reply = Reply::default();
    if let Some(wanted) = asked.wanted() {
        reply.set("wanted", wanted);
        return Ok(reply);
    }
    tell(&mut reply, &compiled);
    let stages = compiled.stages();
    let mut code = Map::new();
    for stage in &stages {
        let mut of_stage = Map::new();
        for word in &request.targets {
            let bytes = compiled.emit(*stage, target_of_word(word)?)?;
            of_stage.insert(word.clone(), reply.bytes(&bytes));
        }
        code.insert(stage.name().to_owned(), Value::Object(of_stage));
    }
    reply.set("code", Value::Object(code));
    if request.reflect && !stages.is_empty() {
        reply.set("reflection", compiled.reflect()?);
    }
    Ok(reply)
}

/// Adds what was found.
pub(crate) fn tell(reply: &mut Reply, compiled: &Compiled) {
    reply.set("sound", compiled.is_sound());
    reply.set("diagnostics", compiled.diagnostics(Format::Json));
    reply.set("human", compiled.diagnostics(Format::Human));
}
