"""The parts of survey_gltf.py."""
