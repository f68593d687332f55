//! [`Gpu`]: an adapter and its device, opened once and used for any number of scenes.

use super::Error;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Facts about the adapter, for reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterFacts {
    /// The name in Vulkan: `llvmpipe (LLVM 15.0.6, 256 bits)`.
    pub name: String,
    /// The driver's version text.
    pub driver: String,
}

/// An open device. It serves any number of scenes, one at a time, and keeps nothing of a scene.
pub struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) features: wgpu::Features,
    pub(super) limits: wgpu::Limits,
    pub(super) timeout: Duration,
    facts: AdapterFacts,
    /// An error outside every error scope, such as a lost device.
    stray: Arc<Mutex<Option<Error>>>,
}

/// The features that are requested if the adapter has them. The scene decides later what it needs.
const WANTED: wgpu::Features = wgpu::Features::PASSTHROUGH_SHADERS
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::PIPELINE_STATISTICS_QUERY)
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::CLIP_DISTANCES)
    .union(wgpu::Features::PRIMITIVE_INDEX)
    .union(wgpu::Features::DUAL_SOURCE_BLENDING)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

impl Gpu {
    /// The time limit of a scene, unless [`Gpu::with_timeout`] sets another.
    pub const DEFAULT_TIMEOUT: Duration = Duration::from_secs(60);

    /// Opens the first software adapter of Vulkan, or the first whose name contains `adapter`, ignoring case.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::UnknownAdapter`], or [`Error::Unsupported`] if the device cannot be opened.
    pub fn new(adapter: Option<&str>) -> Result<Self, Error> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let chosen = choose(&adapters, adapter)?;
        let info = chosen.get_info();
        let features = chosen.features() & WANTED;
        let limits = chosen.limits();
        let (device, queue) = pollster::block_on(chosen.request_device(&wgpu::DeviceDescriptor {
            label: Some("glisten"),
            required_features: features,
            required_limits: limits.clone(),
            ..wgpu::DeviceDescriptor::default()
        }))
        .map_err(|error| Error::Unsupported(format!("a device that can be opened: {error}")))?;
        let stray = Arc::new(Mutex::new(None));
        watch(&device, &stray);
        let facts = AdapterFacts { name: info.name, driver: format!("{} {}", info.driver, info.driver_info) };
        Ok(Self { device, queue, features, limits, timeout: Self::DEFAULT_TIMEOUT, facts, stray })
    }

    /// This device with another limit for each wait.
    #[must_use]
    pub fn with_timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }

    /// The name and driver of the adapter.
    pub fn adapter(&self) -> &AdapterFacts {
        &self.facts
    }

    /// Runs `work` and turns errors that wgpu reports meanwhile into an [`Error`].
    pub(super) fn guarded<T>(&self, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        let scopes = [wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation]
            .map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let mut complaint = None;
        for scope in scopes.into_iter().rev() {
            complaint = pollster::block_on(scope.pop()).map(|error| refusal(&error)).or(complaint);
        }
        let stray = self.stray.lock().unwrap_or_else(PoisonError::into_inner).take();
        match complaint.or(stray) {
            Some(error) => Err(error),
            None => result,
        }
    }

    /// Waits for all submitted work.
    ///
    /// After a timeout the device is leaked on purpose: dropping it would wait for the work that hangs.
    pub(super) fn wait(&self) -> Result<(), Error> {
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(self.timeout) };
        match self.device.poll(wait) {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => {
                std::mem::forget((self.device.clone(), self.queue.clone()));
                Err(Error::Timeout(self.timeout))
            }
            Err(error) => Err(Error::Lost(error.to_string())),
        }
    }

    /// Reports an error that names the missing feature.
    pub(super) fn require(&self, feature: wgpu::Features, what: &str) -> Result<(), Error> {
        if self.features.contains(feature) { Ok(()) } else { Err(Error::Unsupported(what.into())) }
    }
}

fn choose<'a>(adapters: &'a [wgpu::Adapter], name: Option<&str>) -> Result<&'a wgpu::Adapter, Error> {
    let Some(name) = name else {
        return adapters
            .iter()
            .find(|adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu)
            .ok_or(Error::NoAdapter);
    };
    let wanted = name.to_lowercase();
    adapters.iter().find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted)).ok_or_else(|| {
        Error::UnknownAdapter {
            name: name.into(),
            available: adapters.iter().map(|adapter| adapter.get_info().name).collect(),
        }
    })
}

/// Keeps wgpu from panicking on errors outside every error scope.
fn watch(device: &wgpu::Device, stray: &Arc<Mutex<Option<Error>>>) {
    let errors = Arc::clone(stray);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        *errors.lock().unwrap_or_else(PoisonError::into_inner) = Some(refusal(&error));
    }));
    let losses = Arc::clone(stray);
    device.set_device_lost_callback(move |reason, message| {
        if reason != wgpu::DeviceLostReason::Destroyed {
            *losses.lock().unwrap_or_else(PoisonError::into_inner) = Some(Error::Lost(message));
        }
    });
}

/// Extracts the message: wgpu's text is a chain of causes, one per line, of which the last ones say what is wrong.
fn refusal(error: &wgpu::Error) -> Error {
    match error {
        wgpu::Error::OutOfMemory { .. } => Error::Refused("the device is out of memory".into()),
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
            let lines: Vec<&str> = description.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
            Error::Refused(lines.join("; "))
        }
    }
}
