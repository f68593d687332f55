//! Unit tests of the tables of built-in functions.

use super::*;
use crate::language::Scalar;

#[test]
fn every_function_has_a_row_and_every_row_a_signature() {
    for &function in BuiltinFunction::ALL {
        assert!(
            all().any(|row| row.function == function && row.name == function.name()),
            "{} has no row",
            function.name()
        );
    }
    for row in all() {
        let count = row.signatures(Stage::Fragment).count();
        assert!(count >= 1, "{}", row.prototype());
        assert!(row.params.len() <= MAX_PARAMS, "{}", row.prototype());
        assert!(!row.section.is_empty(), "{}", row.prototype());
    }
}

/// The number of prototypes in each section of GLSL 1.50, counted by hand in its text.
#[test]
fn the_table_has_the_specifications_count_of_prototypes() {
    let count = |section: &str| all().filter(|row| row.section == section && !row.deprecated).count();
    assert_eq!(count("§8.1"), 15);
    assert_eq!(count("§8.2"), 7);
    assert_eq!(count("§8.3"), 40);
    assert_eq!(count("§8.4"), 8);
    assert_eq!(count("§8.5"), 25);
    assert_eq!(count("§8.6"), 23);
    // One fewer than in the text: see the module `texture`.
    assert_eq!(count("§8.7"), 149);
    assert_eq!(count("§8.8"), 3);
    assert_eq!(count("§8.9"), 4);
    assert_eq!(count("§8.10"), 2);
    assert_eq!(all().filter(|row| row.deprecated && row.section == "§8.7").count(), 26);
}

#[test]
fn no_two_signatures_of_a_name_are_equal() {
    for (name, stage) in names().flat_map(|name| Stage::ALL.map(|stage| (name, stage))) {
        let mut seen = Vec::new();
        for row in named(name).iter().filter(|row| row.availability.stages.has(stage)) {
            for signature in row.signatures(stage) {
                let types: Vec<_> = signature.params().to_vec();
                // `f(genType, float)` and `f(genType, genType)` coincide for scalars, by the specification itself.
                let scalars = types.iter().all(|&(ty, _)| ty.index() < 18 && (ty.index() - 2) % 4 == 0);
                assert!(scalars || !seen.contains(&types), "{name}: {types:?}");
                seen.push(types);
            }
        }
    }
}

#[test]
fn lookup_finds_all_rows_of_a_name_and_none_of_another() {
    assert_eq!(named("atan").len(), 2);
    assert_eq!(named("texture").len(), 15);
    assert!(named("fmad").is_empty());
    assert_eq!(named("texture2DRect").len(), 1);
}

#[test]
fn bias_is_for_fragment_shaders() {
    let row = named("texture").iter().find(|row| row.prototype().contains("gsampler2D ")).copied();
    let row = row.expect("the table has texture(gsampler2D)");
    assert_eq!(row.signatures(Stage::Vertex).count(), 3);
    assert_eq!(row.signatures(Stage::Fragment).count(), 6);
    assert_eq!(row.prototype(), "gvec4 texture(gsampler2D sampler, vec2 P [, float bias])");
    let biased = row.signatures(Stage::Fragment).last().expect("six signatures");
    assert_eq!(biased.params().len(), 3);
    assert_eq!(biased.ret, TypeId::vector(Scalar::Uint, 4));
    assert_eq!(biased.describe("texture", &Types::new()), "uvec4 texture(usampler2D, vec2, float)");
}
