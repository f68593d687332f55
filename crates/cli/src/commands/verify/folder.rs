//! `glisten verify` over a folder of scenes, and its formats for continuous integration.
//!
//! *In:* scene files. *Out:* a line for each and a summary; JSON; GitHub's annotations; JUnit's XML. *Holds:* a scene that
//! cannot be read or drawn does not keep the others from being judged.

use super::{Judged, Run, VerifyArgs, VerifyFormat, examine, worst_of};
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use glisten_front::diagnostic::write::escaped_xml;
use glisten_verify::verify::Headline;
use glisten_verify::verify::{Conclusion, mark};
use serde_json::Value;
use std::time::Instant;

/// The verdict on one scene.
struct Case {
    scene: String,
    seconds: f64,
    /// `None` if it was not drawn.
    conclusion: Option<Conclusion>,
    /// The covered pixels that are judged or excused, and all of them.
    judged: [u64; 2],
    /// The word for the former.
    judged_word: &'static str,
    exit: Exit,
    headline: Option<Headline>,
    report: Value,
}

impl Case {
    fn new(scene: &str, started: Instant, (exit, judged): (Exit, Option<Judged>)) -> Self {
        let seconds = started.elapsed().as_secs_f64();
        let mut case = Self {
            scene: scene.to_owned(),
            seconds,
            conclusion: None,
            judged: [0; 2],
            judged_word: "judged",
            exit,
            headline: None,
            report: Value::Null,
        };
        if let Some(Judged { verification, runs, report }) = judged {
            let worst: Option<Run> = worst_of(&runs);
            case.conclusion = Some(verification.conclusion());
            case.headline = worst.as_ref().and_then(|worst| Headline::of(&verification, &worst.verdict));
            case.judged_word = worst.as_ref().map_or("judged", |worst| worst.verdict.judged_word());
            case.judged = worst.map_or([0; 2], |worst| [worst.verdict.evidence.good(), worst.verdict.covered]);
            case.report = serde_json::from_str(&report).unwrap_or_default();
        }
        case
    }

    fn mark(&self) -> &'static str {
        self.conclusion.map_or("NOT DRAWN", mark)
    }

    /// The fault, in a sentence.
    fn why(&self) -> &str {
        self.headline.as_ref().map_or("it could not be read or drawn: see above", |headline| &headline.text)
    }

    fn is_wrong(&self) -> bool {
        self.exit != Exit::Ok
    }
}

/// Judges each scene.
pub(super) fn run(args: &VerifyArgs, scenes: &[String], console: &Console) -> Outcome {
    let mut cases = Vec::new();
    for scene in scenes {
        let started = Instant::now();
        let judged = match examine(args, &args.scene.at(scene), console) {
            Ok(judged) => judged,
            // Of several scenes, the others may still be drawn.
            Err(Failure { exit, message, help }) if scenes.len() > 1 && exit != Exit::Machine => {
                console.failure(&message, help.as_deref());
                (exit, None)
            }
            Err(failure) => return Err(failure),
        };
        let case = Case::new(scene, started, judged);
        if args.format == VerifyFormat::Human {
            console.output(&line(&case))?;
        }
        cases.push(case);
    }
    let text = match args.format {
        VerifyFormat::Human => summary(&cases),
        VerifyFormat::Json => json(&cases),
        VerifyFormat::Github => cases.iter().filter(|case| case.is_wrong()).map(annotation).collect(),
        VerifyFormat::Junit => junit(&cases),
    };
    console.output(&text)?;
    Ok(cases.iter().map(|case| case.exit).max().unwrap_or(Exit::Ok))
}

fn line(case: &Case) -> String {
    let [judged, covered] = case.judged;
    let counts = match case.conclusion {
        Some(_) => format!(", {judged} of {covered} pixels {}", case.judged_word),
        None => String::new(),
    };
    let mut text = format!("{}: {}{counts}\n", case.scene, case.mark());
    if let Some(headline) = &case.headline {
        text.push_str(&format!("  {}\n", headline.text));
    }
    text
}

fn summary(cases: &[Case]) -> String {
    let count = |wanted: Option<Conclusion>| cases.iter().filter(|case| case.conclusion == wanted).count();
    let mut parts = vec![format!("{} hold", count(Some(Conclusion::Holds)))];
    let others = [
        (count(Some(Conclusion::Inconclusive)), "inconclusive"),
        (count(Some(Conclusion::Fails)), "do not hold"),
        (count(None), "not drawn"),
    ];
    parts.extend(others.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
    format!("{} scenes: {}\n", cases.len(), parts.join(", "))
}

/// An array with the report of each scene and its name.
fn json(cases: &[Case]) -> String {
    let report = |case: &Case| {
        let mut report = match &case.report {
            Value::Object(report) => report.clone(),
            _ => serde_json::Map::new(),
        };
        report.insert("scene".to_owned(), case.scene.clone().into());
        report.insert("exit".to_owned(), (case.exit as u8).into());
        Value::Object(report)
    };
    let all: Vec<Value> = cases.iter().map(report).collect();
    serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
}

/// GitHub's command for an annotation (GitHub Docs, Workflow commands).
fn annotation(case: &Case) -> String {
    let data = |text: &str| text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A");
    let property = |text: &str| data(text).replace(':', "%3A").replace(',', "%2C");
    let place = case.headline.as_ref().and_then(|headline| headline.place.clone());
    let (file, line, column) = place.unwrap_or_else(|| (case.scene.clone(), 1, 1));
    let title = format!("{}: {}", case.scene, case.mark());
    format!(
        "::error file={},line={line},col={column},title={}::{}\n",
        property(&file),
        property(&title),
        data(case.why())
    )
}

/// The format of JUnit's reports, which most systems for continuous integration read.
fn junit(cases: &[Case]) -> String {
    let wrong =
        |is_drawn: bool| cases.iter().filter(|case| case.is_wrong() && case.conclusion.is_some() == is_drawn).count();
    let seconds: f64 = cases.iter().map(|case| case.seconds).sum();
    let totals = format!(
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{seconds:.3}\"",
        cases.len(),
        wrong(true),
        wrong(false)
    );
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {totals}>\n<testsuite name=\"glisten verify\" {totals}>\n"
    );
    for case in cases {
        let name = escaped_xml(&case.scene);
        text.push_str(&format!("<testcase classname=\"verify\" name=\"{name}\" time=\"{:.3}\"", case.seconds));
        if case.is_wrong() {
            let tag = if case.conclusion.is_some() { "failure" } else { "error" };
            let (kind, why) = (escaped_xml(case.mark()), escaped_xml(case.why()));
            text.push_str(&format!("><{tag} type=\"{kind}\" message=\"{why}\">{why}</{tag}></testcase>\n"));
        } else {
            text.push_str("/>\n");
        }
    }
    text + "</testsuite>\n</testsuites>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(exit: Exit, why: &str) -> Case {
        let headline =
            (!why.is_empty()).then(|| Headline { text: why.to_owned(), place: Some(("a,b.frag".to_owned(), 3, 7)) });
        let conclusion = headline.as_ref().map(|_| Conclusion::Fails);
        Case {
            scene: "a<b>.toml".to_owned(),
            seconds: 0.5,
            conclusion,
            judged: [3, 4],
            judged_word: "judged",
            exit,
            headline,
            report: Value::Null,
        }
    }

    #[test]
    fn formats_escape_what_they_must() {
        let wrong = case(Exit::Content, "100 % of \"x\"\nare <wrong>");
        assert_eq!(
            annotation(&wrong),
            "::error file=a%2Cb.frag,line=3,col=7,title=a<b>.toml%3A DOES NOT HOLD::100 %25 of \"x\"%0Aare <wrong>\n"
        );
        let xml = junit(&[wrong, case(Exit::Content, ""), Case { exit: Exit::Ok, ..case(Exit::Ok, "x") }]);
        assert!(xml.contains("tests=\"3\" failures=\"1\" errors=\"1\" time=\"1.500\""), "{xml}");
        assert!(xml.contains("message=\"100 % of &quot;x&quot;\nare &lt;wrong&gt;\""), "{xml}");
        assert!(xml.contains("name=\"a&lt;b&gt;.toml\" time=\"0.500\"/>"), "{xml}");
    }
}
