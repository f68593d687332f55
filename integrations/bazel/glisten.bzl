"""Rules that compile OpenGL 3.2 era GLSL with glisten.

Actions are hermetic: they read their declared inputs, run the binary of the toolchain, and see no environment. So they give the same
bytes on every machine, and a remote cache or a cluster may run them.
"""

_TOOLCHAIN = "@rules_glisten//:toolchain_type"

# The extension of the files of each target.
_EXTENSIONS = {
    "glsl": "glsl",
    "hlsl": "hlsl",
    "msl": "metal",
    "spirv": "spv",
    "wgsl": "wgsl",
}

# The extensions that tell a stage.
_STAGES = ["vert", "vs", "vsh", "glslv", "vp", "geom", "gs", "gsh", "frag", "fs", "fsh", "glslf", "fp"]

GlistenInfo = provider(
    doc = "Files to include.",
    fields = {
        "files": "A depset of files.",
        "folders": "A depset of folders, in the order in which they are searched.",
    },
)

GlistenProgramInfo = provider(
    doc = "The outputs of a program.",
    fields = {
        "code": "A dictionary from targets to lists of files, one for each stage.",
        "reflection": "The file with the reflection.",
    },
)

GlistenToolchainInfo = provider(
    doc = "The compiler.",
    fields = {"glisten": "The file of the binary."},
)

def _toolchain_impl(ctx):
    return [platform_common.ToolchainInfo(info = GlistenToolchainInfo(glisten = ctx.executable.glisten))]

glisten_toolchain = rule(
    implementation = _toolchain_impl,
    doc = "A glisten to compile with.",
    attrs = {
        "glisten": attr.label(
            doc = "The binary.",
            allow_single_file = True,
            cfg = "exec",
            executable = True,
            mandatory = True,
        ),
    },
)

def _joined(folder, name):
    return folder if name in ["", "."] else folder + "/" + name if folder else name

def _folder_of(ctx, name):
    """The folders that a name in a BUILD file means: of sources, and of generated files."""
    inside = _joined(ctx.label.workspace_root, ctx.label.package)
    return [
        _joined(inside, name) or ".",
        _joined(_joined(ctx.bin_dir.path, inside), name),
    ]

def _library_impl(ctx):
    own = [folder for name in ctx.attr.includes for folder in _folder_of(ctx, name)]
    deps = [dep[GlistenInfo] for dep in ctx.attr.deps]
    files = depset(ctx.files.srcs, transitive = [dep.files for dep in deps])
    folders = depset(own, transitive = [dep.folders for dep in deps], order = "topological")
    return [DefaultInfo(files = files), GlistenInfo(files = files, folders = folders)]

glisten_library = rule(
    implementation = _library_impl,
    doc = "Files that programs include.",
    attrs = {
        "deps": attr.label_list(doc = "Libraries that these files include.", providers = [GlistenInfo]),
        "includes": attr.string_list(doc = "Folders of the search path, from this package.", default = ["."]),
        "srcs": attr.label_list(doc = "The files.", allow_files = True),
    },
)

# What programs and permutations have in common.
_ATTRIBUTES = {
    "attributes": attr.string_dict(doc = "Locations of vertex attributes, as by glBindAttribLocation."),
    "defines": attr.string_dict(doc = "Macros that are defined before the first line."),
    "deps": attr.label_list(doc = "Libraries to include.", providers = [GlistenInfo]),
    "options": attr.string_list(doc = "More flags of `glisten compile`, such as `--clip-z=minus-one-to-one`."),
    "outputs": attr.string_dict(doc = "Color numbers of fragment outputs, as by glBindFragDataLocation."),
    "targets": attr.string_list(doc = "Target languages: glsl, hlsl, msl, spirv, wgsl.", default = ["wgsl", "spirv"]),
}

def _arguments(ctx, folder):
    """The command line for all that is not a source."""
    arguments = ctx.actions.args()
    arguments.add_all(["compile", "--quiet", "--color", "never", "--jobs", "1"])
    arguments.add("--output", folder)
    for target in ctx.attr.targets:
        if target not in _EXTENSIONS:
            fail("`%s` is no target: %s" % (target, ", ".join(sorted(_EXTENSIONS))))
    arguments.add_all(ctx.attr.targets, before_each = "--target")
    for name, value in sorted(ctx.attr.defines.items()):
        arguments.add("-D", name + "=" + value)
    for name, location in sorted(ctx.attr.attributes.items()):
        arguments.add("--bind-attrib", name + "=" + location)
    for name, number in sorted(ctx.attr.outputs.items()):
        arguments.add("--bind-frag-data", name + "=" + number)
    folders = depset(transitive = [dep[GlistenInfo].folders for dep in ctx.attr.deps], order = "topological")
    arguments.add_all(folders, before_each = "-I", uniquify = True)
    arguments.add_all(ctx.attr.options)
    return arguments

def _run(ctx, arguments, inputs, outputs, mnemonic, message):
    libraries = [dep[GlistenInfo].files for dep in ctx.attr.deps]
    ctx.actions.run(
        executable = ctx.toolchains[_TOOLCHAIN].info.glisten,
        arguments = arguments,
        inputs = depset(inputs, transitive = libraries),
        outputs = outputs,
        # Nothing of the environment reaches the compiler.
        env = {},
        use_default_shell_env = False,
        mnemonic = mnemonic,
        progress_message = message,
    )

def _stem(name):
    name = name[:-len(".glsl")] if name.endswith(".glsl") else name
    return name.rpartition(".")[0]

def _check_sources(ctx):
    for file in ctx.files.srcs:
        name = file.basename[:-len(".glsl")] if file.basename.endswith(".glsl") else file.basename
        if name.rpartition(".")[2] not in _STAGES:
            fail("`%s` tells no stage: put what programs include into a glisten_library" % file.short_path)

def _compiled(ctx, folder, more, mnemonic, message):
    """The outputs of one program in a folder, and the action that makes them."""
    code = {
        target: [
            ctx.actions.declare_file("%s/%s.%s" % (folder, source.basename, _EXTENSIONS[target]))
            for source in ctx.files.srcs
        ]
        for target in ctx.attr.targets
    }
    reflection = ctx.actions.declare_file("%s/%s.json" % (folder, _stem(ctx.files.srcs[0].basename)))
    arguments = _arguments(ctx, reflection.dirname)
    arguments.add_all(more)
    arguments.add_joined("--program", ctx.files.srcs, join_with = ",")
    outputs = [file for files in code.values() for file in files] + [reflection]
    _run(ctx, [arguments], ctx.files.srcs, outputs, mnemonic, message)
    return GlistenProgramInfo(code = code, reflection = reflection)

def _program_impl(ctx):
    _check_sources(ctx)
    program = _compiled(ctx, ctx.label.name, [], "GlistenCompile", "Compiling shaders of %{label}")
    groups = {target: depset(files) for target, files in program.code.items()}
    files = depset([program.reflection], transitive = groups.values())
    return [
        DefaultInfo(files = files, runfiles = ctx.runfiles(transitive_files = files)),
        OutputGroupInfo(reflection = depset([program.reflection]), **groups),
        program,
    ]

glisten_program = rule(
    implementation = _program_impl,
    doc = "Compiles the stages of one program. Outputs are in a folder of the rule's name, one file a stage and target, and the " +
          "reflection; the output groups have the names of targets, and `reflection`.",
    attrs = dict(
        _ATTRIBUTES,
        srcs = attr.label_list(doc = "A file for each stage.", allow_files = True, allow_empty = False, mandatory = True),
    ),
    toolchains = [_TOOLCHAIN],
)

def _variants(keywords):
    """All combinations of keywords, the last varying fastest."""
    variants = [{}]
    for name in keywords:
        variants = [dict(variant, **{name: value}) for variant in variants for value in keywords[name]]
    return variants

def _defines_of(variant):
    """The flags of a variant: a keyword without a value is not defined."""
    return ["-D" + name + "=" + value for name, value in variant.items() if value != ""]

def _by_keywords(ctx):
    """One action for each variant: those of a cluster run at once, and an edit compiles what it reaches."""
    _check_sources(ctx)
    programs, rows = [], []
    for number, variant in enumerate(_variants(ctx.attr.keywords)):
        folder = "%s/%d" % (ctx.label.name, number)
        message = "Compiling variant %d of %%{label}" % number
        program = _compiled(ctx, folder, _defines_of(variant), "GlistenVariant", message)
        programs.append(program)
        rows.append(struct(
            defines = variant,
            outputs = {
                target: ["%d/%s" % (number, file.basename) for file in files]
                for target, files in program.code.items()
            },
            reflection = "%d/%s" % (number, program.reflection.basename),
        ))
    index = ctx.actions.declare_file(ctx.label.name + "/index.json")
    ctx.actions.write(index, struct(variants = rows).to_json() + "\n")
    code = [file for program in programs for files in program.code.values() for file in files]
    return code + [program.reflection for program in programs] + [index]

def _by_file(ctx):
    """One action for the whole file: the compiler shares work among variants, and equal outputs are one file."""
    folder = ctx.actions.declare_directory(ctx.label.name)
    arguments = _arguments(ctx, folder.path)
    arguments.add("--permutations", ctx.file.permutations)
    inputs = ctx.files.srcs + [ctx.file.permutations]
    _run(ctx, [arguments], inputs, [folder], "GlistenPermutations", "Compiling variants of %{label}")
    return [folder]

def _permutations_impl(ctx):
    if bool(ctx.attr.permutations) == bool(ctx.attr.keywords):
        fail("give either `permutations` or `keywords`")
    files = depset(_by_file(ctx) if ctx.attr.permutations else _by_keywords(ctx))
    return [DefaultInfo(files = files, runfiles = ctx.runfiles(transitive_files = files))]

glisten_permutations = rule(
    implementation = _permutations_impl,
    doc = "Compiles the variants of a program: with `keywords`, an action for each variant; with `permutations`, one action for a " +
          "file of `glisten compile --permutations`.",
    attrs = dict(
        _ATTRIBUTES,
        keywords = attr.string_list_dict(doc = "Macros, each with its values. The empty value leaves it undefined."),
        permutations = attr.label(doc = "A file of `glisten compile --permutations`.", allow_single_file = True),
        srcs = attr.label_list(doc = "A file for each stage.", allow_files = True, allow_empty = False, mandatory = True),
    ),
    toolchains = [_TOOLCHAIN],
)
