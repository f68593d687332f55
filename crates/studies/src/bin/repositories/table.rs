//! [`Row`]: the numbers of one repository, and the lines of the page.
//!
//! *In:* checked programs. *Out:* Markdown.

use crate::checks::{Answer, Checked};
use crate::list::{List, Repository};
use std::time::Duration;

/// The numbers of a repository.
#[derive(Debug, Default)]
pub(crate) struct Row {
    texts: usize,
    programs: usize,
    accepted: usize,
    elsewhere: usize,
    both: usize,
    /// Refused with the name of a feature that glisten does not read.
    unread: usize,
    naga: Share,
    tint: Share,
    spirv: Share,
    picture: Share,
    /// Of the pictures that are the same, those judged by what is known of the device.
    as_device: usize,
    /// Pictures of which nobody could decide more: nothing is covered, or the language leaves them undefined.
    undefined: usize,
    open: usize,
    slowest: Duration,
    /// Disagreements: the class, the file and what is said.
    pub(crate) found: Vec<(&'static str, String, String)>,
}

/// So many of so many.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    good: usize,
    all: usize,
}

impl Share {
    fn add(&mut self, answer: &Answer) {
        let is_answer = matches!(answer, Answer::Good | Answer::Bad(_));
        self.all += usize::from(is_answer);
        self.good += usize::from(*answer == Answer::Good);
    }

    fn plus(&mut self, other: Self) {
        self.good += other.good;
        self.all += other.all;
    }

    fn shown(self) -> String {
        if self.all == 0 { "–".to_owned() } else { format!("{} of {}", self.good, self.all) }
    }
}

/// The head of the table.
pub(crate) const HEAD: &str = "| repository | commit | texts | programs | accepted | glslang or Mesa accepts | of these | not read | WGSL by naga \
    | by Tint | SPIR-V by spirv-val | same picture | as the device | empty or undefined | inconclusive | slowest |\n\
    | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |";

/// The codes for features, and for extensions, that glisten does not read.
const UNREAD: [&str; 2] = ["E0001", "E0125"];

impl Row {
    /// Adds a program.
    pub(crate) fn add(&mut self, checked: &Checked) {
        self.texts += checked.files.len();
        self.programs += 1;
        let accepted = checked.glisten == Answer::Good;
        self.accepted += usize::from(accepted);
        let elsewhere = checked.is_accepted_elsewhere();
        self.elsewhere += usize::from(elsewhere);
        self.both += usize::from(accepted && elsewhere);
        self.naga.add(&checked.naga);
        self.tint.add(&checked.tint);
        self.spirv.add(&checked.spirv);
        self.picture.add(&checked.picture);
        self.as_device += usize::from(checked.as_device);
        self.slowest = self.slowest.max(checked.time);
        let files: Vec<&str> = checked.files.iter().map(|(name, _)| name.as_str()).collect();
        let files = files.join(", ");
        if let Answer::Without(why) = &checked.picture {
            let is_undefined = why.contains("nothing is covered") || why.contains("undefined by the language");
            self.undefined += usize::from(is_undefined);
            self.open += usize::from(!is_undefined && (why.contains("inconclusive") || why.contains("too long")));
            self.found.push(("not drawn", files.clone(), why.clone()));
        }
        if accepted && !elsewhere {
            let others = [&checked.glslang, &checked.mesa].map(|answer| match answer {
                Answer::Bad(why) => why.as_str(),
                _ => "",
            });
            self.found.push(("refused by others", files.clone(), others.join(" / ")));
        }
        if !accepted && elsewhere {
            let who = if checked.glslang == Answer::Good { "glslang" } else { "Mesa" };
            if let Answer::Bad(why) = &checked.glisten {
                self.unread += usize::from(UNREAD.iter().any(|code| why.starts_with(code)));
                self.found.push(("refused", files.clone(), format!("{why}; {who} accepts it")));
            }
        } else if let Answer::Bad(why) = &checked.glisten {
            self.found.push(("wrong", files.clone(), why.clone()));
        }
        let others = [
            ("WGSL, naga", &checked.naga),
            ("WGSL, Tint", &checked.tint),
            ("SPIR-V", &checked.spirv),
            ("picture", &checked.picture),
        ];
        for (class, answer) in others {
            match answer {
                Answer::Bad(why) => self.found.push((class, files.clone(), why.clone())),
                Answer::Without(why) if class != "picture" && class != "WGSL, Tint" => {
                    self.found.push(("no code", files.clone(), why.clone()));
                }
                _ => {}
            }
        }
    }

    /// Adds another row.
    pub(crate) fn plus(&mut self, other: &Self) {
        self.texts += other.texts;
        self.programs += other.programs;
        self.accepted += other.accepted;
        self.elsewhere += other.elsewhere;
        self.both += other.both;
        self.unread += other.unread;
        self.naga.plus(other.naga);
        self.tint.plus(other.tint);
        self.spirv.plus(other.spirv);
        self.picture.plus(other.picture);
        self.as_device += other.as_device;
        self.undefined += other.undefined;
        self.open += other.open;
        self.slowest = self.slowest.max(other.slowest);
    }

    /// The row of the table.
    pub(crate) fn line(&self, name: &str, commit: &str) -> String {
        let percent = |share: Share| match share.all {
            0 => "–".to_owned(),
            all => format!("{:.1} %", 100.0 * share.good as f64 / all as f64),
        };
        let of_these = percent(Share { good: self.both, all: self.elsewhere });
        let Self { texts, programs, accepted, elsewhere, unread, as_device, undefined, open, .. } = self;
        let [naga, tint, spirv, picture] = [self.naga, self.tint, self.spirv, self.picture].map(Share::shown);
        let slowest = format!("{:.2} s", self.slowest.as_secs_f64());
        format!(
            "| {name} | {commit} | {texts} | {programs} | {accepted} | {elsewhere} | {of_these} | {unread} | {naga} | {tint} | {spirv} \
             | {picture} | {as_device} | {undefined} | {open} | {slowest} |"
        )
    }

    /// The disagreements of a repository that count, each with its reason if that is known.
    pub(crate) fn disagreements(&self, repository: &Repository, list: &List) -> Vec<String> {
        let counts = |class: &str| !["wrong", "not drawn", "refused by others"].contains(&class);
        let found = self.found.iter().filter(|(class, ..)| counts(class));
        let lines = found.map(|(class, file, message)| {
            let because = list.because(&repository.name, class, file, message).unwrap_or("not explained");
            let cell = |text: &str| text.replace('|', "\\|");
            format!("| {} | {class} | `{}` | {} | {because} |", repository.name, cell(file), cell(message))
        });
        lines.collect()
    }
}
