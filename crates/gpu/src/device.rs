//! [`Gpu`]: an adapter and its device, opened once and used for any number of scenes.

use super::{Error, PrecisionLimits};
use glisten_emit::FloatWidth;
use std::fmt;
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

impl fmt::Display for AdapterFacts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, driver {}", self.name, self.driver)
    }
}

/// The environment variable that names the adapter to use, if the caller names none.
pub const ADAPTER_VARIABLE: &str = "GLISTEN_ADAPTER";
/// The name that stands for any software adapter.
pub const SOFTWARE: &str = "software";

/// An open device. It serves any number of scenes, one at a time, and keeps nothing of a scene.
pub struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) features: wgpu::Features,
    pub(super) limits: wgpu::Limits,
    pub(super) timeout: Duration,
    facts: AdapterFacts,
    precision: Option<PrecisionLimits>,
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
    .union(wgpu::Features::SHADER_F16)
    .union(wgpu::Features::SHADER_F64)
    .union(wgpu::Features::CLIP_DISTANCES)
    .union(wgpu::Features::PRIMITIVE_INDEX)
    .union(wgpu::Features::DUAL_SOURCE_BLENDING)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

/// The feature that a width of floats needs.
pub(super) fn feature_of(floats: FloatWidth) -> wgpu::Features {
    match floats {
        FloatWidth::Half => wgpu::Features::SHADER_F16,
        FloatWidth::Single => wgpu::Features::empty(),
        FloatWidth::Double => wgpu::Features::SHADER_F64,
    }
}

impl Gpu {
    /// The time limit of a scene, unless [`Gpu::with_timeout`] sets another.
    pub const DEFAULT_TIMEOUT: Duration = Duration::from_secs(60);

    /// Opens the first adapter of Vulkan whose name contains `adapter`, ignoring case, or the first software adapter if
    /// that is [`SOFTWARE`]. Without a name, [`ADAPTER_VARIABLE`] may give one; else the first that can be opened counts,
    /// hardware before software.
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
        let kinds: Vec<(String, wgpu::DeviceType)> =
            adapters.iter().map(wgpu::Adapter::get_info).map(|info| (info.name, info.device_type)).collect();
        let wanted = adapter.map(str::to_owned).or_else(|| std::env::var(ADAPTER_VARIABLE).ok());
        let order = order(&kinds, wanted.as_deref().filter(|name| !name.is_empty()))?;
        let mut refused = None;
        for chosen in order.into_iter().filter_map(|index| adapters.get(index)) {
            match Self::open(chosen) {
                Ok(gpu) => return Ok(gpu),
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        Err(refused.unwrap_or(Error::NoAdapter { software: false, available: Vec::new() }))
    }

    fn open(chosen: &wgpu::Adapter) -> Result<Self, Error> {
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
        let precision = PrecisionLimits::of(chosen);
        let facts = AdapterFacts { name: info.name, driver: format!("{} {}", info.driver, info.driver_info) };
        Ok(Self { device, queue, features, limits, timeout: Self::DEFAULT_TIMEOUT, facts, precision, stray })
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

    /// The precision of its fixed-function parts, if the adapter reports it.
    pub fn precision(&self) -> Option<PrecisionLimits> {
        self.precision
    }

    /// Whether programs can compute with floats of a width.
    pub fn has(&self, floats: FloatWidth) -> bool {
        self.features.contains(feature_of(floats))
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
        // What follows the loss of a device is no fault of its own.
        let (first, second) =
            if matches!(stray, Some(Error::Lost(_))) { (stray, complaint) } else { (complaint, stray) };
        match first.or(second) {
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

/// The adapters to try, by index, the best first: those that a name fits, or all of them.
fn order(adapters: &[(String, wgpu::DeviceType)], wanted: Option<&str>) -> Result<Vec<usize>, Error> {
    let is_software = |kind: wgpu::DeviceType| kind == wgpu::DeviceType::Cpu;
    let available = || adapters.iter().map(|(name, _)| name.clone()).collect();
    let wanted = wanted.map(str::to_lowercase);
    let software = wanted.as_deref() == Some(SOFTWARE);
    let fits = |(name, kind): &(String, wgpu::DeviceType)| match &wanted {
        None => true,
        Some(_) if software => is_software(*kind),
        Some(wanted) => name.to_lowercase().contains(wanted),
    };
    let mut order: Vec<usize> = (0..adapters.len()).filter(|&index| adapters.get(index).is_some_and(fits)).collect();
    match wanted {
        None => order.sort_by_key(|&index| adapters.get(index).map(|(_, kind)| rank(*kind))),
        Some(_) => order.truncate(1),
    }
    match (order.is_empty(), wanted) {
        (false, _) => Ok(order),
        (true, Some(name)) if !software => Err(Error::UnknownAdapter { name, available: available() }),
        (true, _) => Err(Error::NoAdapter { software, available: available() }),
    }
}

/// The place of a kind of adapter among the others, the preferred one first.
fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
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

#[cfg(test)]
mod tests {
    use super::{Error, order};
    use wgpu::DeviceType::{Cpu, DiscreteGpu, IntegratedGpu};

    #[test]
    fn hardware_comes_first_and_a_name_selects() {
        let all = [("llvmpipe", Cpu), ("Intel UHD", IntegratedGpu), ("GeForce", DiscreteGpu)];
        let all = all.map(|(name, kind)| (name.to_owned(), kind));
        assert_eq!(order(&all, None).expect("there are some"), [2, 1, 0]);
        assert_eq!(order(&all, Some("intel")).expect("there is one"), [1]);
        assert_eq!(order(&all, Some("Software")).expect("there is one"), [0]);
        assert_eq!(order(&all[..1], None).expect("software will do"), [0]);
    }

    #[test]
    fn what_is_not_there_is_told_with_what_is() {
        let hardware = [("GeForce".to_owned(), DiscreteGpu)];
        for (wanted, first) in
            [("software", "no Vulkan software adapter"), ("radeon", "no Vulkan adapter is called `radeon`")]
        {
            let error = order(&hardware, Some(wanted)).expect_err("there is none").to_string();
            assert!(error.starts_with(first) && error.contains("`GeForce`"), "{error}");
        }
        for wanted in [None, Some("software"), Some("radeon")] {
            let error = order(&[], wanted).expect_err("there is none");
            assert!(error.is_environment() && error.to_string().contains("none at all"), "{error}");
            assert!(matches!(error, Error::NoAdapter { .. } | Error::UnknownAdapter { .. }));
        }
    }
}
