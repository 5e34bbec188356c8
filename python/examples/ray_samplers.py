"""Samplers on a Ray cluster: two nodes on this machine, one of them killed in the middle; rollouts of both go on coming.

    pip install '.[ray]'
"""

import ray
from ray.cluster_utils import Cluster

cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
far = cluster.add_node(num_cpus=1)
ray.init(address=cluster.address, log_to_driver=False)

from hasard_rs.ray import rollouts, samplers  # noqa: E402

actors = samplers("hasard/RemedyRushLevel1-v0", 2, lanes=8, seed=1, num_cpus=0.5, resolution="64x48")
seen = {0: 0, 1: 0}
before = None
for index, rollout in rollouts(actors, 32):
    seen[index] += 1
    if before is None and min(seen.values()) >= 3:
        cluster.remove_node(far)
        before = dict(seen)
        print("a node is gone after", before, flush=True)
    # The sampler that was there begins anew on the other.
    if before is not None and all(seen[one] >= before[one] + 3 for one in seen):
        break
print("rollouts of each sampler", seen, "shape", rollout["observations"].shape)
ray.shutdown()
cluster.shutdown()
