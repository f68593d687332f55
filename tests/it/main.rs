//! All integration tests in one binary, so that wgpu is linked once, with one module for each area.

mod api;
mod architecture;
#[cfg(feature = "gpu")]
mod areas;
#[cfg(feature = "cli")]
mod baseline;
#[cfg(feature = "cli")]
mod bazel;
#[cfg(feature = "cli")]
mod bindings;
#[cfg(feature = "cli")]
mod borders;
mod build;
#[cfg(unix)]
mod build_runs;
#[cfg(feature = "cli")]
mod build_systems;
#[cfg(feature = "cli")]
mod cache;
#[cfg(feature = "cli")]
mod cache_faults;
#[cfg(feature = "cli")]
mod cli;
mod codes;
#[cfg(feature = "cli")]
mod comparison;
mod configurations;
#[cfg(feature = "cli")]
mod cost;
#[cfg(all(feature = "cli", target_os = "linux"))]
mod crash;
mod cycles;
mod dependencies;
mod diagnostics;
#[cfg(feature = "reference")]
mod drawing;
#[cfg(feature = "lsp")]
mod editor;
mod emit;
#[cfg(feature = "cli")]
mod engines;
#[cfg(feature = "gpu")]
mod envelope;
#[cfg(feature = "cli")]
mod equations;
#[cfg(feature = "cli")]
mod evidence;
#[cfg(feature = "reference")]
mod exec;
mod features;
#[cfg(feature = "cli")]
mod first_hour;
#[cfg(feature = "cli")]
mod first_steps;
#[cfg(feature = "cli")]
mod fixed_function;
mod fixes;
#[cfg(feature = "gpu")]
mod floats;
mod fmt;
#[cfg(feature = "cli")]
mod gallery;
#[cfg(feature = "gpu")]
mod geometry;
#[cfg(feature = "cli")]
mod gltf_scenes;
#[cfg(feature = "gpu")]
mod gpu;
mod growth;
mod helps;
#[cfg(feature = "cli")]
mod host;
mod hostile;
#[cfg(feature = "gpu")]
mod hostile_calls;
#[cfg(all(feature = "cli", feature = "gpu", unix))]
mod killed;
#[cfg(feature = "gpu")]
mod layers;
mod layouts;
#[cfg(feature = "gpu")]
mod library;
#[cfg(feature = "cli")]
mod limits;
#[cfg(feature = "cli")]
mod lines;
mod link;
mod lint;
mod lint_cache;
mod lint_groups;
mod lint_numerics;
#[cfg(feature = "reference")]
mod lit_scenes;
#[cfg(feature = "lsp")]
mod lsp;
#[cfg(feature = "lsp")]
mod lsp_broken;
#[cfg(feature = "lsp")]
mod lsp_day;
#[cfg(feature = "lsp")]
mod lsp_edits;
#[cfg(feature = "lsp")]
mod lsp_folders;
#[cfg(feature = "lsp")]
mod lsp_shown;
mod lsp_strings;
#[cfg(feature = "cli")]
mod made_textures;
mod models;
#[cfg(feature = "gpu")]
mod multisample;
#[cfg(feature = "gpu")]
mod mutation;
#[cfg(feature = "gpu")]
mod mutations;
mod new_scene;
#[cfg(feature = "gpu")]
mod not_checked;
mod numeric;
#[cfg(feature = "gl")]
mod opengl;
mod operations;
#[cfg(feature = "reference")]
mod optimize;
#[cfg(all(feature = "cli", feature = "snapshot"))]
mod own_snapshots;
#[cfg(feature = "cli")]
mod permutations;
#[cfg(feature = "play")]
mod play;
#[cfg(feature = "play")]
mod play_edits;
mod port;
mod port_style;
mod print;
#[cfg(feature = "gpu")]
mod random;
#[cfg(feature = "gpu")]
mod raster;
#[cfg(feature = "gpu")]
mod read_back;
#[cfg(feature = "cli")]
mod readme;
#[cfg(feature = "cli")]
mod release;
#[cfg(feature = "remote")]
mod remote;
#[cfg(feature = "cli")]
mod report;
#[cfg(feature = "cli")]
mod report_checks;
#[cfg(feature = "cli")]
mod report_page;
#[cfg(feature = "cli")]
mod report_ways;
#[cfg(all(feature = "cli", unix))]
mod sarif;
#[cfg(feature = "reference")]
mod scene_helps;
#[cfg(feature = "reference")]
mod scene_sources;
mod scenes;
#[cfg(feature = "cli")]
mod shader_test;
#[cfg(feature = "cli")]
mod shown_inputs;
mod small_stack;
mod snapshots;
#[cfg(feature = "reference")]
mod specialize;
#[cfg(feature = "gpu")]
mod sprites;
#[cfg(feature = "cli")]
mod stability;
#[cfg(feature = "cli")]
mod stability_exact;
#[cfg(feature = "cli")]
mod stability_library;
#[cfg(feature = "cli")]
mod stability_page;
#[cfg(feature = "gpu")]
mod study;
mod support;
mod tangents;
mod targets;
#[cfg(feature = "cli")]
mod trace;
#[cfg(feature = "cli")]
mod transcripts;
#[cfg(feature = "gpu")]
mod tutorial;
#[cfg(feature = "cli")]
mod unit_tests;
#[cfg(feature = "cli")]
mod upgrade;
mod versions;
#[cfg(feature = "cli")]
mod vulkan;
mod vulkan_blocks;
mod vulkan_trees;
#[cfg(feature = "cli")]
mod watch;
#[cfg(feature = "cli")]
mod web;
mod wgsl;
#[cfg(feature = "reference")]
mod widths;
mod witness;
mod words;
