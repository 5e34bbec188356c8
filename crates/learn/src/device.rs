//! Where networks are computed, chosen at run time.

use burn::tensor::Device;

use crate::error::LearnError;

/// A place to compute.
#[derive(Clone, Debug)]
pub enum ComputeDevice {
    /// The processor, with the kernels of [`crate::cpu`].
    Processor,
    /// A device of the `burn` crate.
    Burn(Device),
}

impl ComputeDevice {
    /// The device of a name: `cpu`; `flex` (burn's processor backend, for comparison); with the cargo features of the
    /// same names `vulkan` and `cuda`, with a colon and a number for another card than the first.
    pub fn named(name: &str) -> Result<ComputeDevice, LearnError> {
        let (kind, index) = name.split_once(':').unwrap_or((name, "0"));
        let index: usize = index
            .parse()
            .map_err(|_| LearnError::Config(format!("device '{name}' has no number after the colon; write {kind}:0")))?;
        match kind {
            "cpu" => Ok(ComputeDevice::Processor),
            "flex" => Ok(ComputeDevice::Burn(Device::flex())),
            #[cfg(feature = "vulkan")]
            "vulkan" => Ok(ComputeDevice::Burn(Device::vulkan(burn::tensor::DeviceKind::DiscreteGpu(index)))),
            #[cfg(feature = "cuda")]
            "cuda" => Ok(ComputeDevice::Burn(Device::cuda(index))),
            "vulkan" | "cuda" => Err(LearnError::Config(format!(
                "this program was built without {kind}; build it with `--features {kind}`, or use --device cpu (card {index})"
            ))),
            _ => Err(LearnError::Config(format!("device '{name}' is unknown; use one of cpu, flex, vulkan, cuda"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_always_there_and_unknown_devices_are_refused() {
        assert!(matches!(ComputeDevice::named("cpu"), Ok(ComputeDevice::Processor)));
        assert!(matches!(ComputeDevice::named("flex"), Ok(ComputeDevice::Burn(_))));
        for bad in ["tpu", "cuda:x", ""] {
            assert!(ComputeDevice::named(bad).is_err(), "{bad}");
        }
        #[cfg(not(feature = "cuda"))]
        assert!(ComputeDevice::named("cuda").unwrap_err().to_string().contains("--features cuda"));
    }
}
