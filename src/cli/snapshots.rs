//! `glisten snapshots`: pending snapshots of tests.
//!
//! *In:* a folder, names. *Out:* a list, a page that shows what changed, or accepted and rejected pictures. *Holds:* nothing is
//! accepted without the command; texts are insta's: they are listed and shown, and accepted by `cargo insta review`.

use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use crate::snapshot::page::page;
use crate::snapshot::pending::{AllPending, Pending, find_all};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten snapshots review -o page.html", "the pictures of tests that wait for a decision"),
    ("glisten snapshots accept", "all of them become the stored ones"),
];

/// Review pending snapshots of tests
#[derive(Args, Debug)]
pub(super) struct SnapshotsArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// List pending pictures and texts
    List {
        #[command(flatten)]
        place: PlaceArgs,
    },
    /// Write a page that shows what changed
    Review {
        #[command(flatten)]
        place: PlaceArgs,
        /// The page to write
        #[arg(short, long, value_name = "FILE", default_value = "target/snapshots.html")]
        output: PathBuf,
    },
    /// Accept pictures: they become the stored ones
    Accept {
        /// The names of those to accept (default: all)
        names: Vec<String>,
        #[command(flatten)]
        place: PlaceArgs,
    },
    /// Reject pictures: they are removed
    Reject {
        /// The names of those to reject (default: all)
        names: Vec<String>,
        #[command(flatten)]
        place: PlaceArgs,
    },
}

/// Where to look.
#[derive(Args, Debug)]
struct PlaceArgs {
    /// The folder to search, with all below it
    #[arg(long, value_name = "DIR", default_value = ".")]
    folder: PathBuf,
}

impl PlaceArgs {
    fn pending(&self) -> Result<AllPending, Failure> {
        let failed = |error| Failure::usage(format!("cannot read the folder `{}`: {error}", self.folder.display()));
        find_all(&self.folder).map_err(failed)
    }
}

/// Runs the command.
pub(super) fn run(args: &SnapshotsArgs, console: &Console) -> Outcome {
    match &args.action {
        Action::List { place } => {
            let pending = place.pending()?;
            let pictures = pending.pictures.iter().map(|one| (&one.name, one.new_picture()));
            let texts = pending.texts.iter().map(|one| (&one.name, one.path.clone()));
            let lines = pictures.chain(texts).map(|(name, path)| format!("{name}  {}\n", path.display()));
            console.output(&lines.collect::<String>())?;
            console.remark(&to_review(&pending));
        }
        Action::Review { place, output } => {
            let pending = place.pending()?;
            if let Some(folder) = output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                files::make_folder(folder)?;
            }
            let html = page(&pending, env!("CARGO_PKG_VERSION"));
            let html = html.map_err(|error| Failure::new(Exit::Content, format!("internal error: {error}")))?;
            files::write(output, html.as_bytes())?;
            console.remark(&format!("{}: {}", to_review(&pending), output.display()));
        }
        Action::Accept { names, place } => {
            decide(&chosen(&place.pending()?, names)?, Pending::accept, "accepted", console)?
        }
        Action::Reject { names, place } => {
            decide(&chosen(&place.pending()?, names)?, Pending::reject, "rejected", console)?
        }
    }
    Ok(Exit::Ok)
}

/// How many there are, in words.
fn to_review(pending: &AllPending) -> String {
    match pending.count() {
        0 => "no snapshots to review".to_owned(),
        1 => "1 snapshot to review".to_owned(),
        count => format!("{count} snapshots to review"),
    }
}

/// The pending pictures with these names; all, if none is given.
fn chosen(pending: &AllPending, names: &[String]) -> Result<Vec<Pending>, Failure> {
    let texts = &pending.texts;
    let pending = &pending.pictures;
    if names.is_empty() {
        return Ok(pending.to_vec());
    }
    if let Some(name) = names.iter().find(|name| pending.iter().all(|one| one.name != **name)) {
        let near = glisten_front::diagnostic::did_you_mean(name, pending.iter().map(|one| one.name.as_str()));
        let failure = Failure::usage(format!("no picture `{name}` is pending"));
        if texts.iter().any(|text| text.name == *name) {
            return Err(failure.help("it is a text: `cargo insta review` accepts and rejects texts"));
        }
        return Err(match near {
            Some(near) => failure.help(format!("did you mean `{near}`?")),
            None => failure.help("`glisten snapshots list` names those that are"),
        });
    }
    Ok(pending.iter().filter(|one| names.contains(&one.name)).cloned().collect())
}

fn decide(
    chosen: &[Pending],
    how: impl Fn(&Pending) -> std::io::Result<()>,
    done: &str,
    console: &Console,
) -> Result<(), Failure> {
    for one in chosen {
        how(one).map_err(|error| Failure::usage(format!("`{}` cannot be {done}: {error}", one.name)))?;
        console.remark(&format!("{done} {}", one.name));
    }
    if chosen.is_empty() {
        console.remark("no pictures to review");
    }
    Ok(())
}
