//! `glisten snapshots`: the pictures of tests that wait for a decision.
//!
//! *In:* a folder, names. *Out:* a list, a page that shows old, new and difference next to each other, or accepted and rejected
//! files. *Holds:* nothing is accepted without the command; texts are insta's, and reviewed by `cargo insta review`.

use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use crate::page::raster::base64;
use crate::snapshot::pending::{Pending, find};
use clap::{Args, Subcommand};
use std::fs;
use std::path::{Path, PathBuf};

/// Review the pictures of snapshot tests
#[derive(Args, Debug)]
pub(super) struct SnapshotsArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// List the pictures that wait
    List {
        #[command(flatten)]
        place: PlaceArgs,
    },
    /// Write a page that shows them
    Review {
        #[command(flatten)]
        place: PlaceArgs,
        /// The page to write
        #[arg(short, long, value_name = "FILE", default_value = "target/snapshots.html")]
        output: PathBuf,
    },
    /// Make them the stored pictures
    Accept {
        /// The names of those to accept (default: all)
        names: Vec<String>,
        #[command(flatten)]
        place: PlaceArgs,
    },
    /// Remove them
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
    fn pending(&self) -> Result<Vec<Pending>, Failure> {
        let failed = |error| Failure::usage(format!("cannot read the folder `{}`: {error}", self.folder.display()));
        find(&self.folder).map_err(failed)
    }
}

/// Runs the command.
pub(super) fn run(args: &SnapshotsArgs, console: &Console) -> Outcome {
    match &args.action {
        Action::List { place } => {
            let lines =
                place.pending()?.into_iter().map(|one| format!("{}  {}\n", one.name, one.new_picture().display()));
            console.output(&lines.collect::<String>())?;
        }
        Action::Review { place, output } => {
            let pending = place.pending()?;
            if let Some(folder) = output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                files::make_folder(folder)?;
            }
            files::write(output, page(&pending).as_bytes())?;
            console.remark(&format!("{} pictures wait: {}", pending.len(), output.display()));
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

/// The pending pictures with these names; all, if none is given.
fn chosen(pending: &[Pending], names: &[String]) -> Result<Vec<Pending>, Failure> {
    if names.is_empty() {
        return Ok(pending.to_vec());
    }
    if let Some(name) = names.iter().find(|name| pending.iter().all(|one| one.name != **name)) {
        let near = glisten_front::diagnostic::did_you_mean(name, pending.iter().map(|one| one.name.as_str()));
        let failure = Failure::usage(format!("no picture `{name}` waits"));
        return Err(match near {
            Some(near) => failure.help(format!("did you mean `{near}`?")),
            None => failure.help("`glisten snapshots list` names those that do"),
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
        console.remark("no picture waits");
    }
    Ok(())
}

const HEAD: &str = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Pictures that wait</title>\n\
    <style>\nbody { font: 16px/1.5 sans-serif; margin: 2rem auto; max-width: 80rem; padding: 0 1rem; }\n\
    figure { display: inline-block; margin: 0 1rem 1rem 0; vertical-align: top; }\n\
    img { background: repeating-conic-gradient(#ccc 0 25%, #fff 0 50%) 0 0/16px 16px; border: 1px solid #888; \
    image-rendering: pixelated; max-width: 24rem; min-width: 8rem; }\n\
    code { background: #eee; padding: .1em .3em; user-select: all; }\n</style>\n</head>\n<body>\n\
    <h1>Pictures that wait</h1>\n";

/// The page, with all pictures inside.
fn page(pending: &[Pending]) -> String {
    let mut text = String::from(HEAD);
    if pending.is_empty() {
        text.push_str("<p>None.</p>\n");
    } else {
        text.push_str("<p>All of them: <code>glisten snapshots accept</code></p>\n");
    }
    for one in pending {
        let name = escaped(&one.name);
        text.push_str(&format!("<section>\n<h2>{name}</h2>\n"));
        for (caption, path) in [("stored", one.stored()), ("new", one.new_picture()), ("difference", one.difference())]
        {
            text.push_str(&figure(caption, &name, &path));
        }
        text.push_str(&format!("<p><code>glisten snapshots accept {name}</code> or ",));
        text.push_str(&format!("<code>glisten snapshots reject {name}</code></p>\n</section>\n"));
    }
    text.push_str("</body>\n</html>\n");
    text
}

fn figure(caption: &str, name: &str, path: &Path) -> String {
    let Ok(bytes) = fs::read(path) else { return String::new() };
    let data = base64(&bytes);
    format!(
        "<figure><img src=\"data:image/png;base64,{data}\" alt=\"{caption} of {name}\"><figcaption>{caption}</figcaption></figure>\n"
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
