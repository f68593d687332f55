//! The messages between page, server and worker: one JSON object each.

use serde::Deserialize;
use std::collections::BTreeMap;

/// A job: what is asked of a scene with these texts.
#[derive(Debug, Deserialize)]
pub struct Job {
    /// The scene file.
    pub scene: String,
    /// The texts that count instead of files.
    #[serde(default)]
    pub texts: BTreeMap<String, String>,
    /// The question.
    #[serde(flatten)]
    pub wish: Wish,
}

/// The question of a job.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case")]
pub enum Wish {
    /// Findings, controls, reflection, and the programs in a language.
    Look {
        /// The word of the language: `wgsl`.
        #[serde(default = "wgsl")]
        target: String,
        /// Whether the programs are without what the picture does not need.
        #[serde(default)]
        leaves_out: bool,
    },
    /// The text of a new scene that draws some shaders.
    NewScene {
        /// The shaders.
        files: Vec<String>,
    },
    /// The picture.
    Draw {
        /// Whether a driver draws it; otherwise the reference does.
        #[serde(default)]
        gpu: bool,
        /// Whether the reference draws one pixel of each block, for a first look at a picture that takes long.
        #[serde(default)]
        coarse: bool,
    },
    /// The pictures of reference and driver, and the verdict on the latter.
    Judge,
    /// The calls of WebGPU that draw the scene.
    Plan,
    /// The picture of what the browser drew.
    Show {
        /// Who drew it.
        by: String,
    },
    /// The verdict on what the browser drew.
    JudgeShown {
        /// Who drew it.
        by: String,
        /// Its window positions, measured.
        #[serde(default)]
        positions: Option<Positions>,
    },
    /// The account of what the picture does not need.
    Needs,
    /// The harm that f32 does to the picture, and its causes.
    Stability,
    /// The error of variants of the scene's shading against their cost.
    Variants,
    /// The values of a pixel of the last pictures.
    Pixel {
        /// From the left.
        x: u32,
        /// From the top.
        y: u32,
    },
    /// The values that the fragments of a pixel computed.
    Trace {
        /// From the left.
        x: u32,
        /// From the top.
        y: u32,
    },
}

/// The window positions between which a GPU interpolates, as a page measured them.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Positions {
    /// The bits of their fraction.
    pub bits: u8,
    /// Whether they are floats. Then the bits are those of edges.
    pub exact: bool,
}

fn wgsl() -> String {
    "wgsl".into()
}

#[cfg(test)]
mod tests {
    use super::{Job, Wish};

    #[test]
    fn jobs_are_read() {
        let job: Job = serde_json::from_str(r#"{"ask":"look","scene":"a.toml","texts":{"a.frag":""}}"#).expect("a job");
        assert!(matches!(job.wish, Wish::Look { ref target, leaves_out: false } if target == "wgsl"));
        assert_eq!(job.texts.len(), 1);
        let job: Job = serde_json::from_str(r#"{"ask":"pixel","scene":"","x":1,"y":2}"#).expect("a job");
        assert!(matches!(job.wish, Wish::Pixel { x: 1, y: 2 }));
        assert!(serde_json::from_str::<Job>(r#"{"ask":"run","scene":""}"#).is_err());
    }
}
