//! [`Gl`]: OpenGL without a window, and the context of one scene.
//!
//! *Holds:* a software device (Mesa's llvmpipe) is preferred, so that a picture does not depend on the machine;
//! without one, Mesa's surfaceless platform selects the device. Every scene has its own context: its state, including
//! errors, ends with the context. The display belongs to the process and is never terminated.

use super::Error;
use super::api::{Api, More};
use super::old::Old;
use khronos_egl as egl;
use std::ffi::{CStr, c_void};
use std::marker::PhantomData;

type Library = egl::DynamicInstance<egl::EGL1_5>;

/// EGL_EXT_platform_device
const PLATFORM_DEVICE: egl::Enum = 0x313F;
/// EGL_MESA_platform_surfaceless
const PLATFORM_SURFACELESS: egl::Enum = 0x31DD;
/// The largest number of devices to examine.
const MOST_DEVICES: usize = 32;
/// The lowest sufficient version of OpenGL.
const OLDEST: (i32, i32) = (3, 2);

/// An EGL display on which OpenGL draws without a window.
pub struct Gl {
    library: Library,
    display: egl::Display,
    config: egl::Config,
    renderer: String,
}

impl Gl {
    /// Finds an OpenGL driver.
    ///
    /// # Errors
    /// [`Error::NoDriver`] if there is none, [`Error::Unsupported`] if it has no core context of OpenGL 3.2 or later.
    pub fn new() -> Result<Self, Error> {
        let library = load()?;
        let mut why = "EGL has neither EGL_EXT_platform_device nor EGL_MESA_platform_surfaceless".to_owned();
        for display in displays(&library) {
            match Self::on(&library, display) {
                Ok((config, renderer)) => return Ok(Self { library, display, config, renderer }),
                Err(Error::NoDriver(reason)) => why = reason,
                Err(other) => return Err(other),
            }
        }
        Err(Error::NoDriver(why))
    }

    /// The renderer and version, as the driver reports them.
    pub fn renderer(&self) -> &str {
        &self.renderer
    }

    fn on(library: &Library, display: egl::Display) -> Result<(egl::Config, String), Error> {
        library.initialize(display).map_err(|error| refused("a display does not start", error))?;
        let wanted = [egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::NONE];
        let config = library.choose_first_config(display, &wanted);
        let config = config.map_err(|error| refused("a display reports no configurations", error))?;
        let config = config.ok_or_else(|| Error::NoDriver("no display draws with OpenGL".to_owned()))?;
        let context = Context::new(library, display, config, false)?;
        let api = context.api();
        let renderer =
            format!("{}, OpenGL {}", api.get_parameter_string(glow::RENDERER), api.get_parameter_string(glow::VERSION));
        Ok((config, renderer))
    }

    /// A context for one scene, current on this thread until dropped: a core context, or one with the fixed-function
    /// pipeline.
    pub(super) fn context(&self, compatibility: bool) -> Result<Context<'_>, Error> {
        Context::new(&self.library, self.display, self.config, compatibility)
    }
}

fn refused(what: &str, error: egl::Error) -> Error {
    Error::NoDriver(format!("{what}: {error}"))
}

#[expect(unsafe_code, reason = "a library is loaded")]
fn load() -> Result<Library, Error> {
    // SAFETY: the library with the name of libEGL is EGL, as the machine has installed it.
    let loaded = unsafe { Library::load_required() };
    loaded.map_err(|error| Error::NoDriver(format!("libEGL 1.5 is not there: {error}")))
}

/// The displays to try, the best first.
fn displays(library: &Library) -> Vec<egl::Display> {
    let extensions = library.query_string(None, egl::EXTENSIONS);
    let extensions = extensions.map(CStr::to_string_lossy).unwrap_or_default();
    let has = |name: &str| extensions.split(' ').any(|extension| extension == name);
    let device = if has("EGL_EXT_platform_device") { software_device(library) } else { None };
    let device = device.and_then(|device| display(library, PLATFORM_DEVICE, device));
    let surfaceless = has("EGL_MESA_platform_surfaceless");
    let surfaceless = surfaceless.then(|| display(library, PLATFORM_SURFACELESS, std::ptr::null_mut())).flatten();
    device.into_iter().chain(surfaceless).collect()
}

#[expect(unsafe_code, reason = "a native display is a pointer to EGL")]
fn display(library: &Library, platform: egl::Enum, native: *mut c_void) -> Option<egl::Display> {
    // SAFETY: `native` is what the platform expects: a device that EGL listed, or nothing.
    unsafe { library.get_platform_display(platform, native, &[egl::ATTRIB_NONE]) }.ok()
}

type QueryDevices = unsafe extern "system" fn(egl::Int, *mut *mut c_void, *mut egl::Int) -> egl::Boolean;
type QueryDeviceString = unsafe extern "system" fn(*mut c_void, egl::Int) -> *const std::ffi::c_char;

/// The device that renders in software (EGL_EXT_device_base, EGL_MESA_device_software).
#[expect(unsafe_code, reason = "functions of extensions have no types of their own")]
fn software_device(library: &Library) -> Option<*mut c_void> {
    let devices = library.get_proc_address("eglQueryDevicesEXT")?;
    let text = library.get_proc_address("eglQueryDeviceStringEXT")?;
    // SAFETY: EGL_EXT_device_base defines these types for the functions with these names.
    let (devices, text) = unsafe {
        (
            std::mem::transmute::<extern "system" fn(), QueryDevices>(devices),
            std::mem::transmute::<extern "system" fn(), QueryDeviceString>(text),
        )
    };
    let mut found = [std::ptr::null_mut(); MOST_DEVICES];
    let mut count = 0;
    // SAFETY: there is room for as many devices as the first argument says.
    if unsafe { devices(MOST_DEVICES as egl::Int, found.as_mut_ptr(), &raw mut count) } != egl::TRUE {
        return None;
    }
    found.into_iter().take(usize::try_from(count).unwrap_or(0)).find(|&device| {
        // SAFETY: the device is one that EGL listed; the text is a zero-terminated constant of EGL.
        let extensions = unsafe {
            let extensions = text(device, egl::EXTENSIONS);
            if extensions.is_null() { None } else { Some(CStr::from_ptr(extensions)) }
        };
        let extensions = extensions.map(CStr::to_string_lossy).unwrap_or_default();
        extensions.split(' ').any(|extension| extension == "EGL_MESA_device_software")
    })
}

/// A context that is current on the thread that made it.
pub(super) struct Context<'a> {
    library: &'a Library,
    display: egl::Display,
    context: egl::Context,
    api: Api,
    /// Keeps the context from being sent to another thread.
    here: PhantomData<*const ()>,
}

impl<'a> Context<'a> {
    fn new(
        library: &'a Library,
        display: egl::Display,
        config: egl::Config,
        compatibility: bool,
    ) -> Result<Self, Error> {
        let (major, minor) = OLDEST;
        let (profile, bit) = if compatibility {
            ("compatibility", egl::CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT)
        } else {
            ("core", egl::CONTEXT_OPENGL_CORE_PROFILE_BIT)
        };
        let too_old = |error| Error::Unsupported(format!("a {profile} context of OpenGL {major}.{minor} ({error})"));
        library.bind_api(egl::OPENGL_API).map_err(|error| refused("EGL has no OpenGL", error))?;
        let wanted = [
            egl::CONTEXT_MAJOR_VERSION,
            major,
            egl::CONTEXT_MINOR_VERSION,
            minor,
            egl::CONTEXT_OPENGL_PROFILE_MASK,
            bit,
            egl::NONE,
        ];
        let context = library.create_context(display, config, None, &wanted).map_err(too_old)?;
        let api = library
            .make_current(display, None, None, Some(context))
            .map_err(|error| refused("a context needs a surface", error))
            .and_then(|()| api(library, compatibility));
        match api {
            Ok(api) => Ok(Self { library, display, context, api, here: PhantomData }),
            Err(error) => {
                // The first error is reported; that the context cannot be destroyed either adds nothing.
                let _ = library.destroy_context(display, context);
                Err(error)
            }
        }
    }

    pub(super) fn api(&self) -> &Api {
        &self.api
    }
}

impl Drop for Context<'_> {
    fn drop(&mut self) {
        // A context that cannot be released remains until the process ends.
        let _ = self.library.make_current(self.display, None, None, None);
        let _ = self.library.destroy_context(self.display, self.context);
    }
}

type ProvokingVertex = extern "system" fn(u32);
type SampleMask = extern "system" fn(u32, u32);
type MultisampleImage = extern "system" fn(u32, i32, u32, i32, i32, i32, u8);

/// The functions of the current context.
#[expect(unsafe_code, reason = "functions are asked for by name")]
fn api(library: &Library, compatibility: bool) -> Result<Api, Error> {
    let address = |name: &str| library.get_proc_address(name);
    // SAFETY: a context is current, and EGL returns the functions with these names.
    let gl = unsafe {
        glow::Context::from_loader_function(|name| address(name).map_or(std::ptr::null(), |found| found as *const _))
    };
    let named = |name: &str| address(name).ok_or_else(|| Error::Unsupported(format!("{name} of OpenGL 3.2")));
    let (provoking, mask) = (named("glProvokingVertex")?, named("glSampleMaski")?);
    let image = named("glTexImage3DMultisample")?;
    // SAFETY: OpenGL 3.2 defines these types for the functions with these names.
    let more = unsafe {
        More {
            provoking_vertex: std::mem::transmute::<extern "system" fn(), ProvokingVertex>(provoking),
            sample_mask_i: std::mem::transmute::<extern "system" fn(), SampleMask>(mask),
            tex_image_3d_multisample: std::mem::transmute::<extern "system" fn(), MultisampleImage>(image),
        }
    };
    let old = if compatibility { Some(Old::load(&address)?) } else { None };
    Ok(Api::new(gl, more, old))
}
