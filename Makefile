# Everything goes through these. What they need is installed without asking; what cannot be is named.

.DEFAULT_GOAL := help
.PHONY: help demo studio test soak fuzz bench bench-studio bench-counts bench-peers schemas pictures notebooks clean

help: ## This list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: ## Build Snell, render the default scene, say where the picture is
	@scripts/demo.sh

studio: ## Build Snell Studio and open it in a browser (SCENE=scene.toml shows that)
	@scripts/studio.sh $(SCENE)

test: ## Everything that CI runs
	@scripts/test.sh

soak: ## Attack triangles with rays for ten minutes, and kill renders (SNELL_SOAK_SECONDS=3600 make soak for longer)
	@scripts/soak.sh

fuzz: ## Fuzz every reader for a minute each (SECONDS_EACH=600 make fuzz for longer)
	@scripts/fuzz.sh

bench: ## Time kernels, trees, rays and pictures (BASELINE=name saves, AGAINST=name compares)
	@scripts/bench.sh

bench-studio: ## How fast the studio is, in Chromium: first picture, dragging, memory, sizes
	@scripts/bench-studio.sh

bench-counts: ## Count instructions under valgrind (BASELINE=1 saves, ONLY=gallery counts less)
	@scripts/bench-counts.sh

bench-peers: ## Compare with POV-Ray and Embree where they are installed, and measure how cost grows
	@scripts/bench-peers.sh

schemas: ## Write the JSON Schemas anew, and the types that are made of them
	@scripts/schemas.sh

pictures: ## Render the pictures of the documentation anew
	@scripts/pictures.sh

notebooks: ## Run the notebooks of the documentation anew, in JupyterLab
	@scripts/notebooks.sh

clean: ## Remove what was built
	cargo clean
	rm -rf .venv out fuzz/target
