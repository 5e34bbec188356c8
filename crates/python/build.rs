//! macOS asks for a flag where symbols come with the interpreter; elsewhere this adds nothing.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
