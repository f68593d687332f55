//! The checks of `glisten report`: what got worse since an earlier report, and the cheapest variant within a budget.
//!
//! *In:* a report. *Out:* lines for people, and the program of the chosen variant in the output folder. *Holds:* what the arguments
//! name is read before anything is drawn, so that a mistake in them costs no time; the earlier report may be the file that the
//! new one replaces.

use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use clap::Args;
use glisten_report::{Budget, Choice, Past, Report};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub(crate) struct CheckArgs {
    /// Compare with an earlier report; exit 1 on regressions
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    /// Name the cheapest variant within these limits of error, write its program, and exit 1 if there is none; of rmse, max_abs,
    /// max_ulp, flip and psnr: `rmse=1e-3,psnr>=40`
    #[arg(long, value_name = "LIMITS")]
    budget: Option<String>,
}

/// The earlier report and the limits that the arguments name.
pub(crate) struct Checks {
    past: Option<(String, Past)>,
    budget: Option<(String, Budget)>,
}

impl CheckArgs {
    /// Reads the earlier report and the limits.
    pub(crate) fn read(&self) -> Result<Checks, Failure> {
        let budget = self.budget.as_ref().map(|text| match Budget::parse(text) {
            Ok(budget) => Ok((text.clone(), budget)),
            Err(error) => Err(Failure::usage(format!("--budget: {error}"))),
        });
        Ok(Checks { past: self.compare.as_deref().map(past).transpose()?, budget: budget.transpose()? })
    }
}

fn past(path: &Path) -> Result<(String, Past), Failure> {
    let name = path.display().to_string();
    let bytes = files::read(&name, path).map_err(|error| {
        let failure = Failure::usage(error.message);
        match error.help {
            Some(help) => failure.help(help),
            None => failure,
        }
    })?;
    match Past::parse(&String::from_utf8_lossy(&bytes)) {
        Ok(past) => Ok((name, past)),
        Err(error) => {
            let message = format!("`{name}` is not a report: {error}");
            Err(Failure::new(Exit::Content, message).help("give it a `report.json` that `glisten report` wrote"))
        }
    }
}

impl Checks {
    /// Checks a report.
    pub(crate) fn apply(&self, report: &Report, folder: &Path, console: &Console) -> Outcome {
        let mut exit = Exit::Ok;
        if let Some((name, past)) = &self.past {
            let found = report.compare(past).map_err(|error| {
                Failure::new(Exit::Content, format!("`{name}` cannot be compared with this report: {error}"))
            })?;
            console.output(&format!("compared with {name}:\n{}", found.lines()))?;
            exit = exit.max(if found.worse.is_empty() { Exit::Ok } else { Exit::Content });
        }
        if let Some((text, budget)) = &self.budget {
            let choices = report.choose(budget);
            for (number, choice) in choices.iter().enumerate() {
                exit = exit.max(chosen(choice, number, (text, budget), folder, console)?);
            }
        }
        Ok(exit)
    }
}

/// Names the variant that was chosen for a model, and writes its program.
fn chosen(
    choice: &Choice<'_>,
    number: usize,
    (text, budget): (&str, &Budget),
    folder: &Path,
    console: &Console,
) -> Outcome {
    let model = choice.model;
    let Some(way) = choice.cheapest else {
        let failure = format!("no variant of `{model}` is within the budget {text}");
        let closest = choice.closest.map(|way| format!("the closest is `{}`: {}", way.title(), budget.figures(way)));
        console.failure(&failure, closest.as_deref());
        return Ok(Exit::Content);
    };
    let stem = if number == 0 { "budget".to_owned() } else { format!("budget_{}", number + 1) };
    let written = way.files(&stem);
    for (name, text) in &written.shaders {
        files::write(&folder.join(name), text.as_bytes())?;
    }
    let scene = folder.join(format!("{stem}.toml"));
    files::write(&scene, written.scene.as_bytes())?;
    let fastest = match choice.fastest {
        Some(fastest) if std::ptr::eq(fastest, way) => "; it is also the fastest".to_owned(),
        Some(fastest) => format!("; the fastest is `{}`", fastest.title()),
        None => "; which is the fastest is open".to_owned(),
    };
    console.output(&format!(
        "budget {text}: `{}` of `{model}` takes the least work: {}, {} operations{fastest}\n",
        way.title(),
        budget.figures(way),
        way.work.operations,
    ))?;
    console.remark(&format!("wrote {}", scene.display()));
    Ok(Exit::Ok)
}
