//! Rewritten sources: `fmt` and `upgrade`.

use super::emit::accepted;
use super::front::compiler;
use crate::Sections;
use glisten::upgrade::{Target, upgrade as upgraded};
use glisten_format::{Options, format as formatted, has_same_lexemes};
use glisten_front::Source;

/// The style of a project.
pub(super) fn format(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    for options in [Options::default(), Options { indent: None, width: 40, braces_below: true }] {
        let once = formatted(&text, &[], &options).text;
        assert!(has_same_lexemes(&text, &once), "other tokens:\n{once}");
        let twice = formatted(&once, &[], &options).text;
        assert!(once == twice, "formatted again, it is different:\n--- once\n{once}\n--- twice\n{twice}");
    }
}

/// Another version. A feature that it lacks is refused, by a sentence of its own or by the errors of the new text.
pub(super) fn upgrade(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let sources = Sections::of(&text).shaders();
    for (word, target) in Target::ALL {
        match upgraded(&compiler(), &sources, target) {
            Ok(new) if target != Target::Vulkan => {
                let with = |(source, text): (&Source, &String)| Source { text: text.as_str().into(), ..source.clone() };
                let sources: Vec<Source> = sources.iter().zip(&new.texts).map(with).collect();
                accepted(&sources, &format!("what was rewritten for {word} is not accepted"));
            }
            _ => {}
        }
    }
}
