//! A thread that makes residuals and their pipelines, and keeps them.

use crate::gpu::{Gpu, Pipeline};
use crate::materials::Material;
use glisten::specialize::{Known, Variants};
use std::collections::BTreeMap;
use std::error::Error;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// A pipeline, or why there is none.
type Made = Result<Arc<Pipeline>, String>;

/// Pipelines by material.
type Pipelines = Arc<Mutex<BTreeMap<&'static str, Made>>>;

pub(crate) struct Worker {
    variants: Arc<Variants>,
    requests: Sender<(&'static str, Known)>,
    asked: Mutex<Vec<&'static str>>,
    made: Pipelines,
}

impl Worker {
    pub(crate) fn new(gpu: Arc<Gpu>, variants: Arc<Variants>) -> Self {
        let (requests, inbox) = channel();
        let made = Pipelines::default();
        let (to, of) = (Arc::clone(&made), Arc::clone(&variants));
        std::thread::spawn(move || work(&gpu, &of, &inbox, &to));
        Self { variants, requests, asked: Mutex::default(), made }
    }

    /// The pipeline of a material's residual, if it is ready; else it is asked for.
    pub(crate) fn ready(&self, material: &Material) -> Result<Option<Arc<Pipeline>>, Box<dyn Error>> {
        if let Some(made) = self.made.lock().unwrap_or_else(PoisonError::into_inner).get(material.name) {
            return Ok(Some(made.clone()?));
        }
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        if !asked.contains(&material.name) {
            asked.push(material.name);
            self.requests.send((material.name, material.known(self.variants.program())))?;
        }
        Ok(None)
    }
}

/// Makes what is asked for. Equal residuals have one pipeline.
fn work(gpu: &Gpu, variants: &Variants, inbox: &Receiver<(&'static str, Known)>, made: &Pipelines) {
    let mut by_variant: BTreeMap<usize, Arc<Pipeline>> = BTreeMap::new();
    for (name, known) in inbox {
        let variant = variants.get(&known);
        let pipeline = match by_variant.get(&variant.id()) {
            Some(pipeline) => Ok(Arc::clone(pipeline)),
            None => gpu.pipeline_of_variant(&variant).map(Arc::new).map_err(|error| error.to_string()),
        };
        if let Ok(pipeline) = &pipeline {
            by_variant.insert(variant.id(), Arc::clone(pipeline));
        }
        made.lock().unwrap_or_else(PoisonError::into_inner).insert(name, pipeline);
    }
}
