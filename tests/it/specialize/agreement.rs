//! All who tell what is left out tell the same: `compile --left-out`, the account, the residual, the page.

use super::{load, scene_files};
use glisten::emit::{left_out, optimize};
use glisten::specialize::specialize_scene;
use glisten_scene::Draw;
use glisten_specialize::Extent;
use glisten_specialize::Kind;
use glisten_specialize::LeftOut;
use glisten_verify::specialize::SpecializedDraw;
use std::collections::BTreeSet;

/// One scene in this many is looked at; `SPECIALIZE_ALL=1` looks at all.
const SHARE: usize = 4;

/// What is wrong with an account next to the residual and the shorter account of `compile`.
fn disagreements(draw: &Draw, left: &Draw, done: &SpecializedDraw, of_compile: &[LeftOut]) -> Vec<String> {
    let mut wrong = Vec::new();
    for one in of_compile {
        let same = |other: &&LeftOut| other.what == one.what && other.name == one.name && other.line == one.line;
        let inside = |other: &&LeftOut| other.extent.start <= one.extent.start && one.extent.end <= other.extent.end;
        if !done.left_out.iter().any(|other| same(&other) || inside(&other)) {
            wrong.push(format!(
                "`compile` leaves out the {} `{}`, the account does not tell",
                one.what.name(),
                one.name
            ));
        }
    }
    let (old, new) = (&draw.program.interface, &left.program.interface);
    let names = |what: Kind| -> BTreeSet<&str> {
        done.left_out.iter().filter(|one| one.what == what).map(|one| one.name.as_str()).collect()
    };
    let mut compare = |what: Kind, before: Vec<&str>, after: Vec<&str>| {
        let gone: BTreeSet<&str> = before.iter().filter(|name| !after.contains(name)).copied().collect();
        let told: BTreeSet<&str> = names(what).into_iter().filter(|name| before.contains(name)).collect();
        if gone != told {
            wrong.push(format!("{}: gone {gone:?}, told {told:?}", what.name()));
        }
    };
    let uniforms = |interface: &glisten_front::link::Interface| -> Vec<String> {
        interface.uniforms.iter().map(|leaf| leaf.name.clone()).collect()
    };
    let (before, after) = (uniforms(old), uniforms(new));
    compare(Kind::Uniform, before.iter().map(String::as_str).collect(), after.iter().map(String::as_str).collect());
    compare(
        Kind::Attribute,
        old.attributes.iter().map(|one| one.name.as_str()).collect(),
        new.attributes.iter().map(|one| one.name.as_str()).collect(),
    );
    compare(
        Kind::Texture,
        old.samplers.iter().map(|one| one.name.as_str()).collect(),
        new.samplers.iter().map(|one| one.name.as_str()).collect(),
    );
    compare(
        Kind::Varying,
        old.varyings.iter().map(|one| one.name.as_str()).collect(),
        new.varyings.iter().map(|one| one.name.as_str()).collect(),
    );
    wrong
}

#[test]
fn everybody_tells_the_same() {
    let step = if std::env::var_os("SPECIALIZE_ALL").is_some() { 1 } else { SHARE };
    let (mut wrong, mut n_draws) = (Vec::new(), 0);
    for path in scene_files().into_iter().step_by(step) {
        let Some((scene, sources)) = load(&path) else { continue };
        let specialized = specialize_scene(&scene, &sources, &[]);
        for ((draw, left), done) in scene.draws.iter().zip(&specialized.scene.draws).zip(&specialized.draws) {
            n_draws += 1;
            let of_compile = left_out(&draw.program, &optimize(&draw.program), Some(&sources));
            // Of a program that nothing is evaluated of the declarations stay that its layout needs.
            if done.extent != Extent::Nothing {
                let found = disagreements(draw, left, done, &of_compile);
                wrong.extend(found.into_iter().map(|what| format!("{}: {what}", path.display())));
            }
        }
    }
    assert!(wrong.is_empty() && n_draws > 20, "{n_draws} draws:\n{}", wrong.join("\n"));
}
