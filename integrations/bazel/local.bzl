"""A toolchain of a glisten that is on this machine."""

_BUILD = """load("@rules_glisten//:glisten.bzl", "glisten_toolchain")

package(default_visibility = ["//visibility:public"])

glisten_toolchain(
    name = "local",
    glisten = "glisten",
)

toolchain(
    name = "toolchain",
    toolchain = ":local",
    toolchain_type = "@rules_glisten//:toolchain_type",
)
"""

def _local_glisten_impl(repository):
    named = repository.os.environ.get("GLISTEN") or repository.attr.path
    found = repository.path(named) if named else repository.which("glisten")
    if not found or not found.exists:
        fail("there is no glisten: give its path by the environment variable GLISTEN or by `path`")
    repository.symlink(found, "glisten")
    repository.file("BUILD.bazel", _BUILD)

local_glisten = repository_rule(
    implementation = _local_glisten_impl,
    doc = "A repository with the binary as an input of actions, and `//:toolchain` for it. The path is that of the variable GLISTEN, " +
          "of `path`, or what PATH finds.",
    attrs = {"path": attr.string(doc = "The path of the binary.")},
    environ = ["GLISTEN", "PATH"],
    local = True,
)
