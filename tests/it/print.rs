//! The printer of the typed program: its text is valid GLSL, has the same meaning, and prints the same again.

use crate::support::{Shader, compile_text, shaders_under};
use glisten_front::Compilation;
use glisten_front::hir::print;

/// The printed text. Shaders of ES 1.00 are printed in a later version, which `specialize` and `upgrade` give them first.
fn printed(compilation: &Compilation) -> Option<String> {
    let program = compilation.program.as_ref()?;
    let shader = program.stages.first().filter(|shader| shader.version.number > 100)?;
    Some(print(&program.types, shader))
}

#[test]
fn printing_and_reading_again_is_stable() {
    let shaders = ["fixtures/valid", "fixtures/programs"].map(shaders_under);
    let mut n_printed = 0;
    let mut failures = Vec::new();
    for Shader { name, text, stage } in shaders.into_iter().flatten() {
        // Other tests handle fixtures with includes or errors.
        let Some(first) = printed(&compile_text(&name, &text, stage)) else { continue };
        n_printed += 1;
        let again = compile_text(&name, &first, stage);
        match printed(&again) {
            None => {
                let messages: Vec<_> = again.diagnostics.iter().map(|found| found.message.clone()).collect();
                failures.push(format!("{name}: the printed text is refused: {messages:?}\n{first}"));
            }
            Some(second) if second != first => {
                failures.push(format!("{name}: differs\n{first}\n--- again ---\n{second}"))
            }
            Some(_) => {}
        }
    }
    assert!(n_printed >= 10, "only {n_printed} fixtures could be printed");
    assert!(failures.is_empty(), "{} of {n_printed}:\n{}", failures.len(), failures.join("\n"));
}
