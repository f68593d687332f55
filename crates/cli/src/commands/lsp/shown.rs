//! The language server's answers besides findings: the macros that conditions ask for, translations, pictures.
//!
//! *In:* texts, programs, scene files. *Out:* choices, texts, picture files. *Holds:* a picture is drawn by another process, from the files
//! as they are on disk; it ends with the server.

use crate::commands::lsp::drawing::{finished, start};
use crate::commands::lsp::project::Files;
use crate::configurations;
use crate::optimize;
use crate::process::guard;
use crate::variants::axes::define;
use glisten_emit::{Conventions, Emitted, Target, emit};
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_lsp::{Choice, Drawn, Shown};
use std::path::Path;
use std::process::Child;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

impl Shown for Files<'_> {
    fn asked(&mut self, texts: &[(String, Arc<str>)]) -> Vec<Choice> {
        let chosen = self.chosen.clone();
        let own = texts.iter().filter(|(name, _)| name != SourceMap::COMMAND_LINE);
        let own: Vec<&str> = own.map(|(_, text)| &**text).collect();
        let given = self.given();
        let choice = |(name, values): (String, Vec<Option<String>>)| {
            let chosen = chosen.get(&name).cloned();
            let mut values = values;
            if !values.contains(&chosen) {
                values.push(chosen.clone());
            }
            Choice { name, values, chosen }
        };
        configurations::asked(&own, &given).into_iter().map(choice).collect()
    }

    fn choose(&mut self, name: &str, value: Option<String>) -> Result<(), String> {
        let text = value.map_or(name.to_owned(), |value| format!("{name}={value}"));
        let is_defined = text.contains('=');
        let (name, value) = define(&text)?;
        if is_defined {
            self.chosen.insert(name, value);
        } else {
            self.chosen.remove(&name);
        }
        Ok(())
    }

    fn chosen(&self) -> Vec<(String, String)> {
        self.chosen.clone().into_iter().collect()
    }

    fn translation(&self, program: &Program, target: &str) -> Result<Vec<(String, String)>, String> {
        let Some(target) = Target::from_word(target) else {
            let names: Vec<&str> = Target::ALL.iter().map(|target| target.word()).collect();
            return Err(format!("there is no language `{target}`: {}", names.join(", ")));
        };
        let made = guard::guarded(|| {
            let optimized = optimize::optimized(program, false);
            let stage = |shader: &glisten_front::hir::Shader| {
                let text = match emit(&optimized, shader.stage, target, &Conventions::default()) {
                    Ok(Emitted::Text(text)) => text,
                    Ok(Emitted::Words(words)) => format!("{} words", words.len()),
                    Err(errors) => {
                        let messages: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
                        return Err(messages.join("\n"));
                    }
                };
                Ok((shader.stage.name().to_owned(), text))
            };
            optimized.stages.iter().map(stage).collect()
        });
        made.unwrap_or_else(|panic| Err(format!("internal error: {panic}")))
    }

    fn picture(&self, scene: &Path, done: Drawn) {
        let child = start(scene);
        let (child, path) = match child {
            Ok(started) => started,
            Err(error) => return done(Err(error)),
        };
        let drawing = Arc::clone(&self.drawing);
        drawing.lock().unwrap_or_else(PoisonError::into_inner).push(Arc::clone(&child));
        thread::spawn(move || {
            let result = finished(&child, path);
            let is_other = |other: &Arc<Mutex<Child>>| !Arc::ptr_eq(other, &child);
            drawing.lock().unwrap_or_else(PoisonError::into_inner).retain(is_other);
            done(result);
        });
    }

    fn end(&mut self) {
        for child in self.drawing.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            // It may have ended by itself.
            let _ = child.lock().unwrap_or_else(PoisonError::into_inner).kill();
        }
    }
}
