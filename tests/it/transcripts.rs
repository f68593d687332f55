//! The command line by transcripts: `fixtures/cli/NAME.md` has commands with their exit codes and all that they print.
//!
//! The commands run in a copy of `NAME.in`, one after the other; what they leave there has to be what is in `NAME.out`.
//! `TRYCMD=overwrite cargo test --all-features --test it -- transcripts` accepts what is printed now.

use std::path::Path;

#[test]
fn the_command_line_says_what_its_transcripts_say() {
    let pages = std::fs::read_dir("fixtures/cli").expect("the transcripts").flatten();
    let n_pages = pages.filter(|entry| entry.path().extension().is_some_and(|extension| extension == "md")).count();
    assert!(n_pages >= 18, "only {n_pages} transcripts are there");
    let cases = trycmd::TestCases::new();
    cases.register_bin("glisten", Path::new(env!("CARGO_BIN_EXE_glisten")));
    cases.env("NO_COLOR", "1");
    cases.case("fixtures/cli/*.md");
    cases.run();
}
