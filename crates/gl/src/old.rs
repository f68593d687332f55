//! [`Old`]: the functions of OpenGL 2.1 that a compatibility context has and a core context lacks.
//!
//! *In:* how to find a function by its name. *Out:* safe function pointers. *Holds:* each takes its numbers by reference to
//! an array that is at least as long as OpenGL reads. All `unsafe` code of these functions is here.

use super::Error;

macro_rules! old {
    ($($(#[$doc:meta])* $field:ident: $name:literal = fn($($argument:ty),*);)*) => {
        /// The functions, as a current compatibility context has them.
        #[derive(Clone, Copy)]
        pub(super) struct Old {
            $($(#[$doc])* pub(super) $field: extern "system" fn($($argument),*),)*
        }

        impl Old {
            /// Loads all functions by their names.
            #[expect(unsafe_code, reason = "functions are asked for by name")]
            pub(super) fn load(address: &dyn Fn(&str) -> Option<extern "system" fn()>) -> Result<Self, Error> {
                let named = |name: &str| address(name).ok_or_else(|| Error::Unsupported(format!("{name} of OpenGL 2.1")));
                Ok(Self {
                    // SAFETY: OpenGL 2.1 defines these types for the functions with these names. A reference to an array
                    // is passed as the pointer to its first number.
                    $($field: unsafe {
                        std::mem::transmute::<extern "system" fn(), extern "system" fn($($argument),*)>(named($name)?)
                    },)*
                })
            }
        }
    };
}

old! {
    matrix_mode: "glMatrixMode" = fn(u32);
    load_matrix: "glLoadMatrixf" = fn(&[f32; 16]);
    light: "glLightfv" = fn(u32, u32, &[f32; 4]);
    light_model: "glLightModelfv" = fn(u32, &[f32; 4]);
    material: "glMaterialfv" = fn(u32, u32, &[f32; 4]);
    fog: "glFogfv" = fn(u32, &[f32; 4]);
    clip_plane: "glClipPlane" = fn(u32, &[f64; 4]);
    point_parameter: "glPointParameterfv" = fn(u32, &[f32; 4]);
    point_size: "glPointSize" = fn(f32);
    texture_environment: "glTexEnvfv" = fn(u32, u32, &[f32; 4]);
    texture_generation: "glTexGenfv" = fn(u32, u32, &[f32; 4]);
    color_material: "glColorMaterial" = fn(u32, u32);
    clamp_color: "glClampColor" = fn(u32, u32);
    shade_model: "glShadeModel" = fn(u32);
    enable_array: "glEnableClientState" = fn(u32);
    client_unit: "glClientActiveTexture" = fn(u32);
    vertex_pointer: "glVertexPointer" = fn(i32, u32, i32, usize);
    normal_pointer: "glNormalPointer" = fn(u32, i32, usize);
    color_pointer: "glColorPointer" = fn(i32, u32, i32, usize);
    secondary_pointer: "glSecondaryColorPointer" = fn(i32, u32, i32, usize);
    fog_pointer: "glFogCoordPointer" = fn(u32, i32, usize);
    coordinate_pointer: "glTexCoordPointer" = fn(i32, u32, i32, usize);
    color: "glColor4fv" = fn(&[f32; 4]);
    secondary_color: "glSecondaryColor3fv" = fn(&[f32; 4]);
    normal: "glNormal3fv" = fn(&[f32; 4]);
    fog_coordinate: "glFogCoordfv" = fn(&[f32; 4]);
    coordinate: "glMultiTexCoord4fv" = fn(u32, &[f32; 4]);
}
